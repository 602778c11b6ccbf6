"""A version of a model in a store, as `fit` and `add` give it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.errors import UsageError, unknown_name
from thermodata.notebook.comparison import SCORES, Comparison, compared, scores_of
from thermodata.notebook.courses import Contributions, Predictions
from thermodata.notebook.figure import Plot
from thermodata.notebook.own_units import in_own_units
from thermodata.notebook.residuals import ResidualTests
from thermodata.notebook.shown import Listed, Shown, html_table
from thermodata.notebook.stale import heed, heed_no_band
from thermodata.notebook.verdict import Confirmation, Verdict
from thermodata.report.collected.lost import lost_sentence
from thermodata.report.text.added import before_after_text
from thermodata.report.text.fit import fit_text, span
from thermodata.report.words.numbers import change, in_units

if TYPE_CHECKING:
    from thermodata.schema.answers.locked_error import LockedError
    from thermodata.schema.answers.result import Check, FitResult, Parameter
    from thermodata.store import Store


class Fit(Shown):
    """Frozen: what changes a model gives another one. result: what the command's --json prints."""

    def __init__(self, store: Store, result: FitResult) -> None:
        self.store, self.result = store, result

    @property
    def id(self) -> str:
        return self.result.model

    @property
    def name(self) -> str:
        return self.result.name

    @property
    def parent(self) -> Fit | None:
        """The version before; None where there is none."""
        return None if self.result.parent is None else stored_fit(self.store, self.result.parent)

    @property
    def stale(self) -> str | None:
        """What of its data changed since it was fitted, and what to do; None where nothing did."""
        from thermodata.store.catalogue.models.stale import stale_line

        return stale_line(self.store, self.id)

    @property
    def responses(self) -> list[str]:
        named = self.result.response
        return [named] if isinstance(named, str) else list(named)

    @property
    def unit(self) -> str:
        """Of the response and its errors."""
        from thermodata.view.lists.models import model_rows

        return next((m.unit for m in model_rows(self.store) if m.model == self.id), "um")

    def unit_of(self, response: str) -> str:
        """Of the errors of one response."""
        from thermodata.view.lists.response_units import unit_of

        return unit_of(self.store, response, self.result.campaigns)

    @property
    def _units(self) -> dict[str, str]:
        from thermodata.view.lists.response_units import response_units

        return response_units(self.store, self.responses, self.result.campaigns)

    @property
    def parameters(self) -> dict[str, Parameter]:
        """'effect.parameter' -> value, unit and 95 % interval."""
        return self.result.parameters

    @property
    def checks(self) -> list[Check]:
        """What the fit says of itself."""
        return self.result.checks

    @property
    def scores(self) -> Listed:
        """A row a test, response and phase, by free-run simulation."""
        heed(self.store, [self.id])
        return scores_of([self.result], SCORES, self._units)

    def diagnose(self, response: str | None = None) -> Verdict[Fit]:
        """Which effect is missing; from the store where that was asked before, and nothing has changed since. response:
        of which, where the model has several; by default of that of which most is left."""
        from thermodata.diagnosis.run import diagnose

        heed(self.store, [self.id])
        return Verdict(self, diagnose(self.store, self.id, response=response))

    def confirm(self, candidate: str | int, response: str | None = None) -> Confirmation:
        """Opens the locked tests for an effect of your choice, by rank or id; the look is counted. response: of which,
        where the model has several; by default of that which was diagnosed."""
        from thermodata.diagnosis.choice import confirm_choice

        heed(self.store, [self.id])
        return Confirmation(confirm_choice(self.store, self.id, candidate, response)[0])

    def locked(self) -> list[LockedError]:
        """What the model as it stands leaves on the locked tests, a row a response: as they are scored and about each
        test's mean, by test. The look is counted; the same again is none."""
        from thermodata.modelling.on_locked import locked_errors

        heed(self.store, [self.id])
        return locked_errors(self.store, self.id)[0]

    def add(self, *candidates: str | int, plain: bool = False) -> Fit:
        """A new version with further effects: each a rank or id of the diagnosis, or any 'effect:channels'."""
        from thermodata.modelling.add import add

        heed(self.store, [self.id])
        return Fit(self.store, add(self.store, self.id, *candidates, plain=plain))

    def remove(self, effect: str) -> Fit:
        """A new version without an effect."""
        from thermodata.modelling.remove import remove

        heed(self.store, [self.id])
        return Fit(self.store, remove(self.store, self.id, effect))

    def compare(self, *others: Fit | str) -> Comparison:
        """This model and others on the data as they are now."""
        return compared(self.store, [self.id, *(o.id if isinstance(o, Fit) else o for o in others)])

    def predict(self, target: Path | str, *, conditions: Mapping[str, str | float] | None = None) -> Predictions:
        """On a campaign of the store, a campaign file, or a folder of logs like the model's own, without displacement.
        'campaign:ID' is the campaign where a path is called so too. What can't be predicted is left out, with the
        reason in `left_out`. conditions: of all tests, as logs without a campaign file say none: {"tool": "A"}.
        UsageError where there is no test; a `NoBandWarning` where the band of 95 % is not known, and is NaN."""
        from thermodata.draft.known.to_predict import Listener, ToPredict, predict_logs

        heed(self.store, [self.id])
        lost = list[str]()
        asked = ToPredict(os.fspath(target), conditions=conditions or {})
        logs = predict_logs(self.store, self.id, asked, Listener(lost.append))
        heed_no_band(logs.band.why_not)
        return Predictions(self.id, logs.made, [*logs.left_out, *lost])

    def contributions(self, test: str | None = None, response: str | None = None) -> Contributions:
        """What each effect gives in a test; in the one with the largest error where none is named. UsageError with the
        nearest name where the model was not predicted there: locked tests stay closed."""
        from thermodata.view.curves.predictions import predictions

        heed(self.store, [self.id])
        response = self._response(response)
        campaign, name = self._test(test, response)
        found = [p for p in predictions(self.store, self.id, campaign, name) if p.response == response]
        if not found:
            raise UsageError(f"the store holds no prediction of {name}", hint=f"thermodata fit {self.id}")
        return Contributions(self.id, found[0], self.unit_of(response))

    def residual_tests(self) -> ResidualTests:
        """Autocorrelation with Ljung-Box, and the residual against each state, over the calibration tests."""
        from thermodata.modelling.run import load
        from thermodata.modelling.seen.as_system import see

        heed(self.store, [self.id])
        loaded = load(self.store, self.id)
        return ResidualTests(self.id, see(loaded.fitted, loaded.data))

    def history(self) -> Listed:
        """The versions that led here, oldest first, with their errors."""
        heed(self.store, [self.id])
        return history_of(self.store, self.id)

    def report(self, path: Path | str) -> Path:
        """Write the page of `thermodata report`."""
        from thermodata.report import build_report

        heed(self.store, [self.id])
        return build_report(self.store, self.id, path)

    def plot(self, test: str | None = None, response: str | None = None) -> Plot:
        """The residual of every test, on the scale of the version before where there is one; and one test with model,
        residual, contributions and drivers: the one with the largest error where none is named."""
        from thermodata.notebook.pictures import pictures

        heed(self.store, [self.id])
        response = self._response(response)
        return Plot(f"{self.name} {self.id}", pictures(self.store, self.id, self._test(test, response), response))

    def summary(self) -> str:
        text = fit_text(self.result, scores=self.result.before is None)
        if self.result.before is not None:
            text = f"{before_after_text(self.result)}\n\n{text}"
        return in_units(text, self._units)

    def html(self) -> str:
        before = {(s.campaign, s.test, s.response): s.rmse_um for s in self.result.before or [] if s.phase == "all"}
        rows = [s.model_dump() for s in self.result.scores if s.phase == "all"]
        for row in rows:
            row["before"] = before.get((row["campaign"], row["test"], row["response"]))
            row["change"] = change(row["before"], row["rmse_um"])
        heads: Sequence[tuple[str, str]] = SCORES
        if before:
            heads = [*SCORES[:4], ("before", "before [um]"), ("rmse_um", "after [um]"), ("change", "change")]
        rows, heads = in_own_units(rows, heads, self._units)
        fitted = [
            {"parameter": k, "value": p.value, "unit": p.unit, "range": span(self.result, k)}
            for k, p in self.result.readable.items()
        ]
        columns = [("parameter", "parameter"), ("value", "value"), ("unit", "unit"), ("range", "95 %")]
        notes = "".join(f"<li>{escape(c.name)}: {escape(c.advice)}</li>" for c in self.result.checks if not c.passed)
        lost = lost_sentence(self.result.before or [], self.result.scores, self.result.checks)
        return (
            (f"<p>{escape(lost)}</p>" if lost else "")
            + html_table(rows, heads, f"{self.name} {self.id}")
            + html_table(fitted, columns)
            + (f"<p>worth a look</p><ul>{notes}</ul>" if notes else "")
        )

    def _response(self, named: str | None) -> str:
        if named is not None and named not in self.responses:
            raise unknown_name("response", named, self.responses)
        return named or self.responses[0]

    def _test(self, named: str | None, response: str) -> tuple[str, str]:
        """'test' or 'campaign/test' -> (campaign, test)."""
        rows = [s for s in self.result.scores if s.phase == "all" and s.response == response]
        if named is None:
            worst = max(rows, key=lambda s: s.rmse_um or 0.0, default=None)
            if worst is None:
                raise UsageError(
                    "the model has no open test",
                    where=f"{self.name} {self.id}",
                    hint="fit it anew to tests that have all that it reads",
                )
            return worst.campaign, worst.test
        for s in rows:
            if named in (s.test, f"{s.campaign}/{s.test}"):
                return s.campaign, s.test
        raise unknown_name("test in the predictions of the model", named, [s.test for s in rows])


def stored_fit(store: Store, ref: str) -> Fit:
    """A version of the store: an id, a unique prefix, or a name (its newest)."""
    from thermodata.store.catalogue.models.fits import find_model

    return Fit(store, find_model(store, ref).result)


def history_of(store: Store, ref: str) -> Listed:
    """The versions that led to a model, as `thermodata history` lists them."""
    from thermodata.report.collected.history import history_rows
    from thermodata.report.text.fit import history_lost, history_table

    rows = history_rows(store, ref)
    shown, columns = history_table(rows)
    return Listed(rows, columns, history_lost(rows), shown=shown)
