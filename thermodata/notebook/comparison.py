"""Models of a store beside each other, and the scores of one and of several as tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from thermodata.notebook.figure import Plot
from thermodata.notebook.own_units import in_own_units
from thermodata.notebook.shown import Listed, Shown, html_table
from thermodata.notebook.stale import heed
from thermodata.report.text.fit import compare_text
from thermodata.report.words.numbers import in_units

if TYPE_CHECKING:
    from thermodata.schema.answers.result import FitResult
    from thermodata.store import Store

SCORES = (
    ("campaign", "campaign"),
    ("test", "test"),
    ("role", "role"),
    ("response", "response"),
    ("phase", "phase"),
    ("fit", "FIT [%]"),
    ("rmse_um", "RMSE [um]"),
    ("max_um", "max [um]"),
    ("n", "n"),
)


class Comparison(Shown):
    """Models on the data as they are now. results: one each, in the order that was asked."""

    def __init__(self, store: Store, results: Sequence[FitResult]) -> None:
        self.store, self.results = store, list(results)

    @property
    def _units(self) -> dict[str, str]:
        from thermodata.view.lists.response_units import response_units

        names = list(dict.fromkeys(s.response for r in self.results for s in r.scores))
        return response_units(self.store, names, {c for r in self.results for c in r.campaigns})

    @property
    def scores(self) -> Listed:
        """All scores, with the model of each."""
        return scores_of(self.results, (("model", "model"), *SCORES), self._units)

    @property
    def differences(self) -> Listed:
        """Each model's error less that of the first, by test, with its interval of 95 %."""
        from thermodata.modelling.comparing import differences_of

        found = differences_of(self.store, [r.model for r in self.results])
        rows = [d.to_json() for d in found]
        heads = [("test", "test"), ("response", "response"), ("model", "model"), ("difference_um", "difference [um]")]
        shown, heads = in_own_units(rows, [*heads, ("low", "low [um]"), ("high", "high [um]")], self._units)
        return Listed(rows, heads, shown=shown)

    def summary(self) -> str:
        return in_units(compare_text(self.results), self._units)

    def html(self) -> str:
        rows: dict[tuple[str, str, str], dict[str, Any]] = {}
        for r in self.results:
            for s in (s for s in r.scores if s.phase == "all"):
                key = (s.campaign, s.test, s.response)
                rows.setdefault(key, {"test": f"{s.campaign}/{s.test}", "response": s.response})[r.model] = s.rmse_um
        heads = [("test", "test"), ("response", "response")]
        heads += [(r.model, f"{r.name} {r.model[:6]} [um]") for r in self.results]
        return html_table(*in_own_units(rows.values(), heads, self._units), "RMSE")

    def plot(self) -> Plot:
        """The residual of every test by each model, on the scale of the first."""
        from thermodata.notebook.pictures import overviews

        found = overviews(self.store, [r.model for r in self.results])
        return Plot("residual of every test", found)


def scores_of(results: Sequence[FitResult], columns: Sequence[tuple[str, str]], units: Mapping[str, str]) -> Listed:
    """Scores as rows, shown each in the unit of its response."""
    rows = [s.model_dump() for r in results for s in r.scores]
    shown, heads = in_own_units(rows, columns, units)
    return Listed(rows, heads, shown=shown)


def compared(store: Store, refs: Sequence[str]) -> Comparison:
    """Models of the store beside each other."""
    from thermodata.modelling.comparing import compare

    results = compare(store, refs)
    heed(store, [result.model for result in results])
    return Comparison(store, results)
