"""The candidates: every effect of the library, bound to every set of channels that fits what it needs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np

from thermodata.diagnosis.cross_validation import Priors
from thermodata.effect.binding import bindings, candidate_id, family_of
from thermodata.modelling.drivers import has_drivers, make_drivers
from thermodata.modelling.lead import columns, with_lead
from thermodata.plugin import Drivers, Effect, Float2D, Param
from thermodata.view.dataset import ChannelInfo, TestData

Led = tuple[Drivers, int]
GENERIC = "generic"
NOT_DRIVERS = frozenset({"displacement", "tilt", "label"})
SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0}
TIME_UNITS = tuple(SECONDS)
# a distributed machine also acts with these multiples of an effect's time constant
SLACK_FACTORS = (0.2, 5.0)
# A gain this many times beyond the plausible range is not that effect.
BEYOND = 1.5


@dataclass(frozen=True, slots=True)
class CandidateEffect:
    """An effect and the channels it would be driven by. family: with the axis that its channels sit on.
    placeless: nobody declared where its channels sit, so it can only be a plain lag."""

    effect: Effect
    binding: Mapping[str, str]
    family: str
    placeless: bool = False

    @property
    def channels(self) -> tuple[str, ...]:
        return tuple(self.binding.values())

    @property
    def id(self) -> str:
        return candidate_id(self.effect.name, self.binding)

    def drivers(self, test: TestData) -> Led | None:
        """What the effect sees of a test; None where the test lacks a channel."""
        return with_lead(make_drivers(test, self.effect, self.binding)) if has_drivers(test, self.binding) else None

    def columns(self, drivers: Led | None, size: int, p: Mapping[str, float]) -> Float2D:
        """Shape (size, gains); zero where there are no drivers."""
        return np.zeros((size, len(self.effect.gains))) if drivers is None else columns(self.effect, drivers, p)

    @property
    def priors(self) -> Priors:
        """Of the gains: from the plausible magnitudes of the effect, and the sign where geometry fixes it."""
        limit = np.array([gain.magnitude[1] * BEYOND for gain in self.effect.gains])
        return Priors(
            limit,
            np.array([0.0 if g.sign == "+" else -b for g, b in zip(self.effect.gains, limit, strict=True)]),
            np.array([0.0 if g.sign == "-" else b for g, b in zip(self.effect.gains, limit, strict=True)]),
        )

    def slack_params(self, p: Mapping[str, float]) -> list[dict[str, float]]:
        """The parameters of the same effect acting faster and slower (see `investigate.slack_columns`)."""
        return [
            {**p, param.name: p[param.name] * factor}
            for param in self.effect.params
            if param.unit in TIME_UNITS
            for factor in SLACK_FACTORS
        ]

    @property
    def refines(self) -> tuple[str, ...]:
        """Effects that this one is a refinement of: it is asked for only where the model has one of them."""
        found: tuple[str, ...] = getattr(self.effect, "refines", ())
        return found


def candidates(
    library: Mapping[str, Effect],
    channels: Mapping[str, ChannelInfo],
    present: Iterable[tuple[str, frozenset[str]]],
    response: str,
) -> list[CandidateEffect]:
    """What could be missing. present: (effect name, its channels) of the model's terms. A plain lag stands for
    channels that no named effect covers; artefacts are looked for within tests, not here."""
    have = set(present)
    lagged = {names for effect, names in have if library.get(effect) is None or library[effect].family == GENERIC}
    usable = {n: c for n, c in channels.items() if n != response and c.quantity not in NOT_DRIVERS}
    named: list[CandidateEffect] = []
    generic: list[CandidateEffect] = []
    for effect in library.values():
        if effect.family == "artefact" or not effect.needs:
            continue
        for binding in bindings(effect, usable):
            nowhere = effect.family == GENERIC and all(usable[c].at is None for c in binding.values())
            candidate = CandidateEffect(effect, binding, family_of(effect, binding, channels), nowhere)
            names = frozenset(candidate.channels)
            if (effect.name, names) in have or names in lagged:
                continue
            if candidate.refines and not any(e in candidate.refines and n & names for e, n in have):
                continue
            (generic if effect.family == GENERIC else named).append(candidate)
    covered = {c for candidate in named for c in candidate.channels}
    covered |= {c for _, names in have for c in names}
    return named + [g for g in generic if not covered.issuperset(g.channels)]


def grid(params: Iterable[Param], step_s: float) -> list[dict[str, float]]:
    """Points of the nonlinear parameters: time constants evenly in their logarithm, others evenly."""
    params = tuple(params)
    if not params:
        return [{}]
    count = {1: 10, 2: 5}.get(len(params), 3)
    axes = []
    for p in params:
        seconds = SECONDS.get(p.unit)
        lower = max(p.lower, step_s / 4 / seconds) if seconds else p.lower
        if seconds or (p.lower > 0 and p.upper / p.lower > 10):
            axes.append(np.geomspace(max(lower, 1e-9), max(p.upper, lower), count))
        else:
            axes.append(np.linspace(p.lower, p.upper, min(count, 4)))
    return [{p.name: float(v) for p, v in zip(params, values, strict=True)} for values in product(*axes)]
