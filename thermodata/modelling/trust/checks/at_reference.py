"""How much of a gain's reference a machine reaches: sizes that are known at 10000 rpm are no limit at 4000."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.effect.guard import guarded_basis, read_only
from thermodata.errors import EffectError
from thermodata.modelling.inputs.drivers import ZERO_AT_REST
from thermodata.modelling.terms.fitted_response import FittedTerm
from thermodata.plugin import Bool1D, Drivers, Float1D
from thermodata.view.grid.dataset import TestData

_SIZES = ZERO_AT_REST - {"state"}  # what a gain may be given at a value of; a state is on or off
_AT_REST_S = 1e9  # longer than any time constant


@dataclass(frozen=True, slots=True)
class Reached:
    """share: of what the effect does at the reference of its gain, what it does at rest at the largest values of its
    drivers that were logged; 1 at most, for sizes are known at the reference. at: these values, '4001 rpm'."""

    share: float = 1.0
    at: str = ""


WHOLE = Reached()


def reached(term: FittedTerm, gain: int, params: Mapping[str, float], tests: Sequence[TestData]) -> Reached:
    """gain: its place among the effect's. tests: those that the model was fitted to."""
    quantities = {need.role: need.quantity for need in term.effect.needs}
    sized = [role for role in term.binding if quantities.get(role) in _SIZES]
    seen = [t for t in tests if term.bound.covers(t) and term.bound.has(t)]
    if not sized or not seen:
        return WHOLE
    largest = {role: max(_largest(term.bound.drivers(t), role) for t in seen) for role in sized}
    held = {role: largest.get(role, 1.0) for role in term.binding}
    try:
        does = float(abs(guarded_basis(term.effect, _constant(held), params)[-1, gain]))
    except EffectError:  # of a plugin that no such drivers were foreseen in
        return WHOLE
    # of a gain that is at no reference (kW), or of a pulse, nothing is told
    if not 0.0 < does < 1.0:
        return WHOLE
    units = {role: _unit(term.binding[role], seen) for role in sized}
    return Reached(does, " and ".join(f"{largest[role]:.4g} {units[role]}".strip() for role in sized))


def _largest(drivers: Drivers, role: str) -> float:
    valid = drivers.values[role][drivers.valid[role]]
    return float(np.abs(valid).max(initial=0.0))


def _constant(held: Mapping[str, float]) -> Drivers:
    """What an effect sees where its drivers stand still for ever."""
    t_s: Float1D = np.array([0.0, _AT_REST_S, 2 * _AT_REST_S])
    valid: Bool1D = np.ones(3, dtype=np.bool_)
    return read_only(Drivers(t_s, {r: np.full(3, v) for r, v in held.items()}, dict.fromkeys(held, valid), {}))


def _unit(channel: str, tests: Sequence[TestData]) -> str:
    return next((t.channels[channel].unit for t in tests if channel in t.channels), "")
