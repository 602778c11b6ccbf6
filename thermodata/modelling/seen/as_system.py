"""A fitted model seen as a system: its linear paths with all that a control engineer asks, and its residual."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.effect import law
from thermodata.effect.law_run import evaluate
from thermodata.effect.law_text import written
from thermodata.effect.linear import Filter, Mode
from thermodata.errors import UsageError
from thermodata.modelling.seen.drive_unit import Powers, over_unit, powers_of
from thermodata.modelling.seen.drive_unit import written as written_unit
from thermodata.modelling.seen.laws import TermLaw, laws
from thermodata.modelling.seen.linear_parts import CurvedError, Path, paths
from thermodata.modelling.seen.residual_tests import Against, LjungBox, against, autocorrelation, lags_told, ljung_box
from thermodata.modelling.seen.state_space import System, system_of
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.modelling.trust.checks.bound_checks import at_bounds
from thermodata.plugin import Float1D
from thermodata.schema.answers.result import Check
from thermodata.view.grid.dataset import Dataset, TestData

POINTS = 240  # of a curve
BELOW = 30.0  # the lowest frequency is that much below the slowest corner
SETTLED = 5.0  # time constants that a step response shows
LONGEST, LONGEST_S = 1440, 8 * 3600.0  # lag of the autocorrelation [samples], [s]
LJUNG_BOX = (10, 20, 50)  # lags


@dataclass(frozen=True)
class SeenPath:
    """One path: from `drive` (as text) through the filter to the response. unit: of its gain at rest. step: (t [s], y)
    of a unit step of the drive; bode: (f [Hz], magnitude in `unit`, phase [deg])."""

    effect: str
    group: str
    drive: str
    times: str | None
    holds: str | None
    unit: str
    system: System
    step: tuple[Float1D, Float1D]
    bode: tuple[Float1D, Float1D, Float1D]

    @property
    def name(self) -> str:
        """What tells it from the model's other paths."""
        parts = [
            self.effect if not self.group else f"{self.effect}[{self.group}]",
            self.holds and f"while {self.holds}",
        ]
        return ", ".join(p for p in parts if p)


@dataclass(frozen=True)
class SeenResponse:
    """One response. not_shown: (effect, why). correlation: r_0 ... at lags of step_s [s], over `count` residuals of the
    calibration tests, which are `tests`; states: the residual against each state."""

    response: str
    unit: str
    step_s: float
    paths: tuple[SeenPath, ...]
    not_shown: tuple[tuple[str, str], ...]
    correlation: Float1D
    count: int
    ljung_box: tuple[LjungBox, ...]
    states: tuple[Against, ...]
    tests: tuple[str, ...] = ()
    at_bounds: tuple[Check, ...] = ()  # what a bound holds, and whose it is


def see(fitted: FittedModel, data: Dataset) -> list[SeenResponse]:
    """Each response of the model on its calibration tests, at the step of the model."""
    return [_response_seen(response, data) for response in fitted.responses]


def _response_seen(response: FittedResponse, data: Dataset) -> SeenResponse:
    systems, hidden, shown = list[tuple[TermLaw, Path, System]](), list[tuple[str, str]](), list[tuple[TermLaw, Path]]()
    for term in response.terms:
        groups = list(term.groups)
        for group in groups:
            found = laws(response, data.channels, data.step_s, {term.id: group})
            one = next(t for t in found if t.id == term.id)
            try:
                if one.why_not is not None:
                    raise CurvedError(one.why_not)
                parts = _paths(one)
                systems += [(one, path, system_of(path.by, data.step_s)) for path in parts]
                shown += [(one, path) for path in parts if group == groups[0]]
            except (CurvedError, UsageError) as error:
                hidden.append((term.id, " ".join(str(error).split())))
    slowest = max((t for _, _, s in systems for t in s.taus_s), default=3600.0)
    lowest = 1.0 / (2 * np.pi * BELOW * max(slowest, data.step_s))
    tests = [t for t in data.tests if t.key in response.calibrate and response.can_predict(t)]
    residuals = [np.where(response.mask(t), response.residual(t), np.nan)[t.in_window] for t in tests]
    count = int(sum(np.isfinite(r).sum() for r in residuals))
    most = min(LONGEST, lags_told(residuals, data.step_s, max(data.step_s, LONGEST_S)))
    correlation = autocorrelation(residuals, most)
    return SeenResponse(
        response.name,
        response.unit,
        data.step_s,
        tuple(_path_seen(term, path, system, response.unit, lowest) for term, path, system in systems),
        tuple(dict.fromkeys(hidden)),
        correlation,
        count,
        tuple(ljung_box(correlation, count, k) for k in LJUNG_BOX if k <= most),
        _states(response, shown, tests, residuals, data.step_s),
        tests=tuple(t.test for t in tests),
        at_bounds=tuple(c for term in response.terms for c in at_bounds(response, term, tests)),
    )


def _paths(term: TermLaw) -> list[Path]:
    total: law.Node = law.ZERO
    for gain in term.gains:
        total = law.fold(law.Binary("+", total, law.Binary("*", law.Number(gain.value), gain.tree)))
    return [p for p in paths(total) if p.drive != law.ZERO]


def _path_seen(term: TermLaw, path: Path, system: System, unit: str, lowest: float) -> SeenPath:
    step_s = system.step_s
    slow = max([*system.taus_s, *(t for t, _ in path.by.late), 10 * step_s])
    n = int(SETTLED * slow / step_s) + 2
    kept = np.unique(np.linspace(0, n - 1, min(n, POINTS)).astype(int))
    response = system.step_response(n)[kept]
    hertz = np.geomspace(lowest, 0.499 / step_s, POINTS)
    answer = system.frequency_response(2 * np.pi * hertz)
    phase = np.rad2deg(np.unwrap(np.angle(answer)))
    return SeenPath(
        term.id,
        term.group,
        _drive_in_channels(path.drive, term),
        None if path.times is None else _drive_in_channels(path.times, term),
        path.holds,
        over_unit(unit, *_drives(path, term, unit)),
        system,
        (kept * step_s, response),
        (hertz, np.abs(answer), phase),
    )


def _drive_in_channels(node: law.Node, term: TermLaw) -> str:
    """The drive in the channels' names."""
    return written(law.put(node, {role: d.tree for role, d in term.drives.items()}))


def _drives(path: Path, term: TermLaw, unit: str) -> list[Powers | None]:
    """The units of what drives a path, and of what it is multiplied by. unit: of the response. Whether a number in
    them is a reference ('at 10000 rpm') the units of the effect's gains tell."""
    units = {role: drive.unit for role, drive in term.drives.items()}
    nodes = [node for node in (path.drive, path.times) if node is not None]
    plain, referred = ([powers_of(node, units, reference) for node in nodes] for reference in (False, True))
    told = {gain.unit for gain in term.gains}
    return referred if over_unit(unit, *plain) not in told and over_unit(unit, *referred) in told else plain


def _states(
    response: FittedResponse,
    shown: Sequence[tuple[TermLaw, Path]],
    tests: Sequence[TestData],
    residuals: Sequence[Float1D],
    step_s: float,
) -> tuple[Against, ...]:
    terms = {t.id: t for t in response.terms}
    found = []
    for term, path in shown:
        modes: list[Mode | None] = [*(m for m in path.by.modes if m.is_real)] or [None]
        for mode in modes:
            # a state has a gain of 1: what is lagged, in the drive's own unit
            node = path.drive
            if mode is not None:
                node = law.Filtered(node, Filter(modes=(replace(mode, weight=1.0),)))
            courses = [_course(terms[term.id], node, t, step_s) for t in tests]
            tau = "" if mode is None or mode.tau_s is None else f" after {_time_constant_shown(mode.tau_s)}"
            unit = written_unit(_drives(path, term, response.unit)[0] or {}) or "1"
            found.append(against(f"{term.id}: {_drive_in_channels(path.drive, term)}{tau}", unit, courses, residuals))
    unique = {a.state: a for a in found}
    return tuple(a for a in unique.values() if len(a.centres))


def _course(term: FittedTerm, node: law.Node, test: TestData, step_s: float) -> Float1D:
    if isinstance(term.effect, OfTests) or not (term.bound.covers(test) and term.bound.has(test)):
        return np.full(int(test.in_window.sum()), np.nan)
    return evaluate(node, term.bound.drivers(test).values, step_s)[test.in_window]


def _time_constant_shown(tau_s: float) -> str:
    minutes = tau_s / 60.0
    return f"{minutes:.3g} min" if minutes < 999.5 else f"{minutes / 60.0:.3g} h"
