"""A diagnosis that can be acted on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

from thermodata.errors import UsageError
from thermodata.notebook.figure import Plot
from thermodata.notebook.shown import Listed, Shown, html_table
from thermodata.report.charts.courses import course_chart
from thermodata.report.page.headline import capital
from thermodata.report.text.confirmed import confirmed_text
from thermodata.report.text.diagnosis import diagnosis_text
from thermodata.report.verdict.verdict import claims_of, told, verdict_sentence
from thermodata.report.words.numbers import in_unit, in_units

if TYPE_CHECKING:
    from thermodata.schema.answers.candidate import Candidate
    from thermodata.schema.answers.confirmed import Confirmed
    from thermodata.schema.answers.diagnosis import Diagnosis

_COLUMNS = (
    ("rank", "#"),
    ("id", "candidate"),
    ("claimed", "claimed"),
    ("probability", "probability"),
    ("p_value", "p"),
    ("rmse_um_before", "before"),
    ("rmse_um_after", "after"),
    ("equivalent", "can't be told from"),
)


F = TypeVar("F")
F_co = TypeVar("F_co", covariant=True)


class Diagnosed(Protocol[F_co]):
    """The model that a verdict is about; F: what a new version of it is."""

    @property
    def name(self) -> str: ...
    def unit_of(self, response: str) -> str: ...
    def add(self, *candidates: str | int, plain: bool = False) -> F_co: ...
    def confirm(self, candidate: str | int, response: str | None = None) -> Confirmation: ...


class Verdict(Shown, Generic[F]):
    """Which effect a model misses, or that none is missing, or that these tests can't tell. result: all of it."""

    def __init__(self, of: Diagnosed[F], result: Diagnosis) -> None:
        self.of, self.result = of, result

    @property
    def verdict(self) -> str:
        """effect, refine, none, unknown or not_testable."""
        return self.result.verdict

    @property
    def sentence(self) -> str:
        """The verdict with its figures."""
        return in_unit(verdict_sentence(self.result), self.unit)

    @property
    def unit(self) -> str:
        """Of the errors of the response that was diagnosed."""
        return self.of.unit_of(self.result.response)

    @property
    def claims(self) -> list[Candidate]:
        """The missing causes that are claimed, the first one first."""
        return claims_of(self.result)

    @property
    def candidates(self) -> Listed:
        """All that were weighed, by rank."""
        return Listed((c.model_dump() for c in self.result.candidates), _COLUMNS)

    def add(self, *candidates: str | int, plain: bool = False) -> F:
        """A new version with candidates, by rank or id; with the first where none is named."""
        return self.of.add(*map(self._id_of, candidates or (1,)), plain=plain)

    def confirm(self, candidate: str | int = 1) -> Confirmation:
        """Opens the locked tests for an effect of your choice; the look is counted."""
        return self.of.confirm(self._id_of(candidate), self.result.response)

    def _id_of(self, candidate: str | int) -> str | int:
        """A rank is one of this verdict, whatever the model was asked since."""
        return next((c.id for c in self.result.candidates if str(c.rank) == str(candidate)), candidate)

    def summary(self) -> str:
        return in_units(diagnosis_text(self.result), {self.result.response: self.unit})

    def html(self) -> str:
        from html import escape

        rows = [c.model_dump() for c in self.result.candidates[:8]]
        more = f"<p>Next test: {escape(self.result.next_test)}</p>" if self.result.next_test else ""
        return f"<p><b>{escape(capital(self.sentence))}</b></p>{html_table(rows, _COLUMNS) if rows else ''}{more}"

    def plot(self) -> Plot:
        """What the model leaves over in each test, and what each candidate that is told of would take of it.
        UsageError where none was weighed."""
        shown = [c for c in told(self.result) if c.courses]
        if not shown:
            raise UsageError(
                "there is no candidate to draw",
                where=f"diagnosis of {self.result.model}",
                hint="the verdict's own words say what the tests lack: print it",
            )
        charts = {f"{c.rank}. {c.id}": course_chart(c, self.unit) for c in shown}
        return Plot(f"what {self.of.name} misses", charts)


class Confirmation(Shown):
    """What the locked tests say of one effect."""

    def __init__(self, result: Confirmed) -> None:
        self.result = result

    @property
    def holds(self) -> bool | None:
        """None where the effect rests in all locked tests."""
        return self.result.holds

    def summary(self) -> str:
        return confirmed_text(self.result)

    def html(self) -> str:
        rows: list[dict[str, Any]] = [t.model_dump() for t in self.result.tests]
        own = [] if self.result.locked_rmse_um_fitted is None else [("rmse_um_fitted", "as fitted")]
        before = "refitted" if own else "before"
        heads = [("test", "test"), *own, ("rmse_um_before", before), ("rmse_um_after", "after")]
        return html_table(rows, heads, confirmed_text(self.result).splitlines()[0])
