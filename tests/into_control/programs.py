"""Effects as control programs, and what they must answer: the effect's own basis on the grid of the cycle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.effect import effect as find_effect
from thermodata.effect import law
from thermodata.export.control.build import build
from thermodata.export.control.program import Input, Limits, Program, Start
from thermodata.modelling.inputs.drivers import ZERO_AT_REST
from thermodata.modelling.seen.laws import Drive, GainLaw, TermLaw
from thermodata.plugin import Drivers, Effect, Float1D
from thermodata.schema.units.quantity import CANONICAL_UNIT

WIDE = Limits(1e6, 1e9)


@dataclass(frozen=True)
class Driven:
    """An effect with its parameters, gains and channels: role -> channel."""

    effect: Effect
    binding: Mapping[str, str]
    p: Mapping[str, float]
    gains: Mapping[str, float]

    def term(self, name: str, step_s: float) -> TermLaw:
        needs = {n.role: n.quantity for n in self.effect.needs}
        units = {q.name: q.unit for q in self.effect.params}
        formulas = self.effect.law(set(self.binding), self.p, step_s)  # type: ignore[attr-defined]
        return TermLaw(
            name,
            self.effect.name,
            "",
            "",
            {
                role: Drive(role, channel, law.Symbol(channel), relative(needs[role]), "1")
                for role, channel in self.binding.items()
            },
            {k: (v, units[k]) for k, v in self.p.items()},
            tuple(
                GainLaw(g.name, self.gains[g.name], g.unit, law.with_parameters(f, self.p, units))
                for g, f in zip(self.effect.gains, formulas, strict=True)
            ),
        )

    def free_run(self, t_s: Float1D, readings: Mapping[str, Float1D]) -> Float1D:
        """gain times basis, on the grid t_s, from balance."""
        needs = {n.role: n.quantity for n in self.effect.needs}
        values = {
            role: readings[c] - (readings[c][0] if relative(needs[role]) else 0.0) for role, c in self.binding.items()
        }
        drivers = Drivers(t_s, values, {r: np.ones(len(t_s), bool) for r in values}, {})
        columns = self.effect.basis(drivers, self.p)
        return np.asarray(columns @ np.array([self.gains[g.name] for g in self.effect.gains]))


def relative(quantity: str) -> bool:
    return quantity not in ZERO_AT_REST and quantity != "position"


def driven(name: str | Effect, gains: float | Mapping[str, float] = 10.0, **p: float) -> Driven:
    """An effect of the library at its start values, with the first of its alternative needs."""
    found = find_effect(name) if isinstance(name, str) else name
    needs = found.needs[:1] if all(n.optional for n in found.needs) else found.needs
    return Driven(
        found,
        {n.role: f"{n.role}_{i}" for i, n in enumerate(needs)},
        {q.name: p.get(q.name, q.start) for q in found.params},
        gains if isinstance(gains, Mapping) else {g.name: gains for g in found.gains},
    )


def program(
    terms: Sequence[Driven],
    cycle_s: float,
    limits: Limits = WIDE,
    step_s: float = 30.0,
    low: float = -1e5,
    start: Start | None = None,
    band: float = 0.0,
) -> Program:
    """A program of some effects. band: within which every drive stands still."""
    inputs: dict[str, Input] = {}
    for one in terms:
        needs = {n.role: n.quantity for n in one.effect.needs}
        for role, channel in one.binding.items():
            quantity = needs[role] if needs[role] != "*" else "temperature"
            inputs[channel] = Input(channel, channel, quantity, CANONICAL_UNIT.get(quantity, "1"), low, 1e5)
    laws = [one.term(f"e{i}", step_s) for i, one in enumerate(terms)]
    blank = Program("model", "dZ", "um", cycle_s, limits, (("model", "test 0123456789ab"),), start)
    return build(blank, laws, inputs, dict.fromkeys(inputs, band))


def day(channels: Mapping[str, str], cycle_s: float, hours: float = 24.0, seed: int = 1) -> dict[str, Float1D]:
    """channel -> a day of readings by quantity: smooth temperatures about 22 degC, speeds in steps."""
    rng = np.random.default_rng(seed)
    n = int(hours * 3600 / cycle_s) + 1
    t = np.arange(n) * cycle_s
    out: dict[str, Float1D] = {}
    for i, (channel, quantity) in enumerate(channels.items()):
        hours_in = n * cycle_s / 3600
        steps = np.repeat(rng.choice([0.0, 0.3, 0.6, 1.0], int(hours_in) + 2), max(1, int(3600 / cycle_s)))[:n]
        steps[: max(1, int(600 / cycle_s))] = 0.0
        wave = 8.0 * np.sin(2 * np.pi * t / (3600 * (5 + i))) + 4.0 * np.sin(2 * np.pi * t / 2700 + i)
        if quantity in ("temperature", "temperature_difference", "*"):
            out[channel] = 22.0 + i + wave - wave[0]
        elif quantity == "position":
            out[channel] = 250.0 + 200.0 * np.sin(2 * np.pi * t / 1800)
        elif quantity == "state":
            out[channel] = (steps > 0.5).astype(np.float64)
        else:
            top = {"rotational_speed": 9000.0, "feed": 15.0, "power": 8.0, "load": 100.0}
            top |= {"irradiance": 600.0, "flow": 20.0, "torque": 40.0, "current": 60.0}
            out[channel] = steps * top.get(quantity, 1.0)
    return out


def readings(terms: Sequence[Driven], cycle_s: float, hours: float = 24.0, seed: int = 1) -> dict[str, Float1D]:
    """A day for all that the terms read."""
    needs: dict[str, Any] = {}
    for one in terms:
        for n in one.effect.needs:
            if n.role in one.binding:
                needs[one.binding[n.role]] = n.quantity
    return day(needs, cycle_s, hours, seed)
