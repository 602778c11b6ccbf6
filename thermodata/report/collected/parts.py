"""The tests of a model as a report shows them: measured and predicted on one grid, what drives them, what ran."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from thermodata.modelling.predictions.score import role_of
from thermodata.plugin import Array, Bool1D, Float1D
from thermodata.report.collected.data import Curve, TestPart
from thermodata.report.words.numbers import base_role
from thermodata.schema.answers.result import Score

if TYPE_CHECKING:
    from thermodata.modelling.run import Loaded
    from thermodata.modelling.terms.fitted import FittedModel
    from thermodata.view.grid.dataset import Dataset, TestData

_LANES = ("rotational_speed", "feed", "power", "load", "state", "flow")
_ROLES = ("calibration", "verification", "locked")
Part = TypeVar("Part", TestPart, Score)
_MOST_LANES, _MOST_DRIVERS = 6, 8


def test_parts(loaded: Loaded) -> list[TestPart]:
    """Every open test of a model and response, by role."""
    return by_role(parts_of(loaded.fitted, loaded.data, {}))


test_parts.__test__ = False  # type: ignore[attr-defined]


def by_role(rows: Iterable[Part]) -> list[Part]:
    """In the order of the work: calibration, verification, the rest; within a role as they came."""
    return sorted(rows, key=lambda r: _ROLES.index(base_role(r.role)) if base_role(r.role) in _ROLES else len(_ROLES))


def parts_of(
    fitted: FittedModel, data: Dataset, conditions: Mapping[tuple[str, str], dict[str, Any]]
) -> Iterable[TestPart]:
    """A part for every open test and response that can be predicted, in the order of the data."""
    from thermodata.modelling.predictions.table import prediction_columns

    drivers = _driver_names(fitted, data)
    for test in fitted.tests(data):
        for response in fitted.responses:
            if response.can_predict(test):
                columns = prediction_columns(response, test)
                role = role_of(fitted, test)
                yield _part(test, response.name, role, columns, drivers, conditions.get(test.key, {}))


def _part(
    test: TestData,
    response: str,
    role: str,
    found: Mapping[str, Array],
    drivers: Sequence[str],
    conditions: dict[str, Any],
) -> TestPart:
    """One prediction with the state of its test, on the prediction's own grid."""
    columns = {name: np.asarray(values, dtype=np.float64) for name, values in found.items()}
    step = float(test.t_s[1] - test.t_s[0]) if len(test.t_s) > 1 else 30.0
    start = float(columns["t_s"][0]) if len(columns["t_s"]) else 0.0
    # a grid with a hole (rows left out) is widened: the page draws by index
    index = np.rint((columns["t_s"] - start) / step).astype(np.int64)
    n = int(index[-1]) + 1 if len(index) else 0

    def spread(values: Float1D) -> Float1D:
        full = np.full(n, np.nan)
        full[index] = values
        return full

    def deviation(name: str) -> Float1D | None:
        known = columns.get(f"sd__{name}")
        return None if known is None else spread(known)

    valid = columns["valid"] > 0
    prefix = "c__"
    inside = (test.t_s >= start - step / 2) & (test.t_s < start + (n - 0.5) * step)
    return TestPart(
        campaign=test.campaign,
        test=test.test,
        kind=test.kind,
        role=role,
        response=response,
        start_s=start,
        step_s=step,
        measured=spread(columns["measured"]),
        predicted=spread(columns["predicted"]),
        residual=spread(np.where(valid, columns["residual"], np.nan)),
        contributions=tuple(
            Curve(name.removeprefix(prefix), "", spread(values), deviation(name.removeprefix(prefix)))
            for name, values in columns.items()
            if name.startswith(prefix)
        ),
        drivers=_curves(test, drivers, inside)[:_MOST_DRIVERS],
        lanes=_curves(test, _lane_names(test), inside)[:_MOST_LANES],
        conditions=conditions,
        phases=dict(test.phases),
        predicted_sd=deviation("predicted"),
        unit=test.channels[response].unit if response in test.channels else None,
    )


def _curves(test: TestData, names: Iterable[str], inside: Bool1D) -> tuple[Curve, ...]:
    """The channels that move in this test; NaN where they are not valid."""
    return tuple(
        Curve(name, test.channels[name].unit, np.where(test.valid[name], test.values[name], np.nan)[inside])
        for name in names
        if _moves(test, name, inside)
    )


def _moves(test: TestData, name: str, inside: Bool1D) -> bool:
    """Whether the channel is there and says something in this test."""
    if name not in test.values or name not in test.channels:
        return False
    values = test.values[name][inside & test.valid[name]]
    return bool(len(values) and np.ptp(values) > 0)


def _lane_names(test: TestData) -> list[str]:
    found = [c for c in test.channels.values() if c.quantity in _LANES]
    return [c.name for c in sorted(found, key=lambda c: _LANES.index(c.quantity))]


def _driver_names(fitted: FittedModel, data: Dataset) -> list[str]:
    """The temperatures that the model's effects are driven by."""
    from thermodata.modelling.inputs.drivers import names_of

    names = [
        name
        for response in fitted.responses
        for term in response.terms
        for text in term.binding.values()
        for name in names_of(text)
    ]
    info = data.channels
    return [n for n in dict.fromkeys(names) if n in info and info[n].quantity.startswith("temperature")]
