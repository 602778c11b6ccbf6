"""What an effect says of itself, in one form for the terminal, JSON and the documents."""

from __future__ import annotations

import inspect
import math
from collections.abc import Sequence
from dataclasses import dataclass

from thermodata.plugin import Effect
from thermodata.schema.units.quantity import CANONICAL_UNIT

NOT_STATED = "not stated"


@dataclass(frozen=True, slots=True)
class Role:
    """A driver that the effect needs. unit: canonical, None where any quantity does. places: () is any place."""

    role: str
    quantity: str
    unit: str | None
    places: tuple[str, ...]
    optional: bool


@dataclass(frozen=True, slots=True)
class Searched:
    """A nonlinear parameter, with start and bounds in `unit`. reach: those of an effect that is added; None where they
    are no wider."""

    name: str
    unit: str
    start: float
    lower: float
    upper: float
    meaning: str
    reach: tuple[float, float] | None = None


def bounds_text(lower: float, upper: float, start: float, reach: Sequence[float] | None) -> str:
    """'10 to 120, from 40; added: 1 to 360'."""
    added = f"; added: {reach[0]:g} to {reach[1]:g}" if reach else ""
    return f"{lower:g} to {upper:g}, from {start:g}{added}"


@dataclass(frozen=True, slots=True)
class Solved:
    """A gain. smallest, largest: plausible absolute values in `unit`; largest is None where nothing bounds it."""

    name: str
    unit: str
    smallest: float
    largest: float | None
    sign: str
    meaning: str


@dataclass(frozen=True, slots=True)
class Description:
    """An effect's own account of itself. equation, telltale: None where the effect states none. told_by: the role
    whose moves tell it from what it refines. closed_by: the feedback of its axis that keeps it from the tool. asked:
    whether diagnosis asks for it by itself. text: its class's docstring."""

    name: str
    family: str
    meaning: str
    equation: str | None
    telltale: str | None
    source: str
    refines: tuple[str, ...]
    told_by: str | None
    closed_by: str | None
    asked: bool
    roles: tuple[Role, ...]
    parameters: tuple[Searched, ...]
    gains: tuple[Solved, ...]
    text: str | None


def describe(effect: Effect) -> Description:
    """The account of any effect that keeps the contract, with or without its optional attributes."""
    return Description(
        name=effect.name,
        family=effect.family,
        meaning=effect.meaning,
        equation=_text(effect, "equation") or _equation_in(inspect.getdoc(type(effect))),
        telltale=_text(effect, "telltale"),
        source=effect.source,
        refines=tuple(getattr(effect, "refines", ())),
        told_by=getattr(effect, "told_by", None),
        closed_by=getattr(effect, "closed_by", None),
        asked=bool(getattr(effect, "asked", True)),
        roles=tuple(
            Role(n.role, n.quantity, CANONICAL_UNIT.get(n.quantity), tuple(n.places), n.optional) for n in effect.needs
        ),
        parameters=tuple(
            Searched(p.name, p.unit, p.start, p.lower, p.upper, p.meaning, p.reach) for p in effect.params
        ),
        gains=tuple(
            Solved(
                g.name,
                g.unit,
                g.magnitude[0],
                g.magnitude[1] if math.isfinite(g.magnitude[1]) else None,
                g.sign,
                g.meaning,
            )
            for g in effect.gains
        ),
        text=inspect.getdoc(type(effect)),
    )


def _text(effect: Effect, name: str) -> str | None:
    value = getattr(effect, name, None)
    return value if isinstance(value, str) and value.strip() else None


def _equation_in(text: str | None) -> str | None:
    return next((line.strip() for line in (text or "").splitlines() if " = " in line), None)
