"""Models beside each other as the source papers print them: what was there at first, what each leaves, and the mean.

Peak to valley stands both ways: max - min ([mares2017], [mares2021]), and |max| + |min| ([straka2021], [horejs2022]),
which depends on where zero is: the mean of the first samples of a test that took no part in the fit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from thermodata.errors import UsageError
from thermodata.modelling.inputs.roles import Key, find_tests
from thermodata.modelling.predictions.score import fit_percent, peak_sum, role_of
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import Dataset, TestData

MEAN = "mean"


@dataclass(frozen=True)
class ModelOnTest:
    """One model on one test, or the mean over the tests that all models predict (test "mean"). In the response's unit.

    initial, residual: max - min of the displacement and of what the model leaves; initial_peaks, residual_peaks:
    |max| + |min|; low, high: range of what is left; fold: initial / residual; against: by how many percent the model
    leaves less peak to valley than the reference (below 0: more). None where the model can't predict: `why`.
    """

    campaign: str
    test: str
    role: str
    response: str
    model: str
    name: str
    fit: float | None = None
    initial: float | None = None
    initial_peaks: float | None = None
    residual: float | None = None
    residual_peaks: float | None = None
    low: float | None = None
    high: float | None = None
    fold: float | None = None
    against: float | None = None
    n: int = 0
    why: str | None = None

    def to_json(self) -> dict[str, Any]:
        return asdict(self)


_MEANS = ("fit", "initial", "initial_peaks", "residual", "residual_peaks", "low", "high")


def models_on_tests(
    models: Sequence[tuple[str, FittedModel, Dataset]], reference: str, tests: Sequence[str] = ()
) -> list[ModelOnTest]:
    """Rows by test, response and model, then the means. models: (id, model, its data), the reference among them.
    tests: only these, as test or campaign/test. UsageError for one that no model knows, or that is closed to all."""
    rows: list[ModelOnTest] = []
    wanted = _tests_named(models, tests)
    for identity, fitted, data in models:
        for response in fitted.responses:
            for test in fitted.tests(data):
                if not tests or test.key in wanted:
                    rows.append(_row(identity, fitted, response, test))
    if closed := [f"{c}/{t}" for c, t in wanted if (c, t) not in {(r.campaign, r.test) for r in rows}]:
        raise UsageError(
            "a test that these models neither fit nor verify",
            where="--test",
            expected="tests with the role calibration or verification",
            got=", ".join(closed),
            hint="leave --test out to compare on all tests that may be; locked ones are opened by "
            "'thermodata confirm' alone",
        )
    rows = [row for row in rows if row.n or row.why]
    rows += _means_over_tests(rows)
    base = {(r.campaign, r.test, r.response): r for r in rows if r.model == reference}
    rows = [_against(row, base.get((row.campaign, row.test, row.response))) for row in rows]
    order = {identity: i for i, (identity, _, _) in enumerate(models)}
    place = {key: i for i, key in enumerate(dict.fromkeys((r.campaign, r.test) for r in rows if r.test != MEAN))}
    return sorted(rows, key=lambda r: (r.response, place.get((r.campaign, r.test), len(place)), order[r.model]))


def _tests_named(models: Sequence[tuple[str, FittedModel, Dataset]], tests: Sequence[str]) -> tuple[Key, ...]:
    every = {test.key: test for _, _, data in models for test in data.tests}
    return find_tests(tests, replace(models[0][2], tests=tuple(every.values())), "--test") if tests else ()


def _row(identity: str, fitted: FittedModel, response: FittedResponse, test: TestData) -> ModelOnTest:
    row = ModelOnTest(test.campaign, test.test, role_of(fitted, test), response.name, identity, fitted.spec.name)
    why = response.why_not(test)
    if why is not None:
        return replace(row, why=why)
    counted = response.mask(test)
    if not counted.any():
        return row
    first = counted & (test.t_s < test.t_s[np.argmax(counted)] + max(test.zero_s, 1e-9))
    measured = response.measured(test) - response.measured(test)[first].mean()
    left: Float1D = response.residual(test)[counted]
    initial, residual = float(np.ptp(measured[counted])), float(np.ptp(left))
    return replace(
        row,
        fit=fit_percent(measured[counted], left),
        initial=initial,
        initial_peaks=peak_sum(measured[counted]),
        residual=residual,
        residual_peaks=peak_sum(left),
        low=float(left.min()),
        high=float(left.max()),
        fold=initial / residual if residual > 0 else None,
        n=int(counted.sum()),
    )


def _means_over_tests(rows: Sequence[ModelOnTest]) -> list[ModelOnTest]:
    """Over the tests that every model predicts: a mean over others would compare other things."""
    found = []
    for response in dict.fromkeys(r.response for r in rows):
        own = [r for r in rows if r.response == response]
        models = list(dict.fromkeys((r.model, r.name) for r in own))
        counts: dict[tuple[str, str], int] = {}
        for r in own:
            counts[r.campaign, r.test] = counts.get((r.campaign, r.test), 0) + (r.n > 0)
        common = {key for key, count in counts.items() if count == len(models)}
        for model, name in models:
            mine = [r for r in own if r.model == model and (r.campaign, r.test) in common]
            if not mine:
                continue
            means: dict[str, Any] = {}
            for key in _MEANS:
                values = [v for r in mine if (v := getattr(r, key)) is not None]
                means[key] = float(np.mean(values)) if values else None
            fold = means["initial"] / means["residual"] if means["residual"] else None
            total = sum(r.n for r in mine)
            found.append(ModelOnTest("", MEAN, "", response, model, name, **means, fold=fold, n=total))
    return found


def _against(row: ModelOnTest, reference: ModelOnTest | None) -> ModelOnTest:
    if reference is None or not reference.residual or row.residual is None or row.model == reference.model:
        return row
    return replace(row, against=(1.0 - row.residual / reference.residual) * 100.0)
