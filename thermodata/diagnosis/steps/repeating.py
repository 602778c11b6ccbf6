"""Steps that repeat, of one size or as one axis starts or stops: the machine makes them, and no probe.

A probe or fixture that slips does so by another amount each time. What sticks and slips, or has play, gives way by one
amount again and again. Between its jumps it keeps back what it should do, and catches up in them: levels with a free
offset each would take the motion for none. So such steps are told together, and the course stays whole.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.steps.artefact import NOTHING_ELSEWHERE
from thermodata.diagnosis.steps.step import Step
from thermodata.diagnosis.steps.who_made import BODY, evenly
from thermodata.plugin import Bool1D
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.view.grid.dataset import TestData

LEAST = 3  # of two that are alike by chance there are many
ALIKE = 0.1  # of their median, that each differs from it by at most
AXIS = ("feed", "position")  # what moves an axis
MOVED = 0.1  # share of what it does in these tests, that makes it a change
BESIDE_S = 120.0  # between a change and its step at most
CHANCE = 0.01  # that as many slips fall beside changes of one axis: where it goes to and fro all the time, all do


def repeating(steps: Sequence[Step]) -> list[list[Step]]:
    """Those of all tests that are alike, where there are so many in one direction, and with them those by which it goes
    back: play is passed through both ways. A list for each size, the most frequent first. And those, of any size, at
    each of which one axis starts, stops or changes, where these are more."""
    found: list[list[Step]] = []
    while rest := _steps_outside(steps, found):
        moved = [s for s in rest if any(n in s.beside for n in moved_by(rest))]
        best = _with_the_way_back(_most_alike(rest), rest)
        if len(best) < LEAST and not moved:
            break
        found.append(moved if len(moved) > len(best) or len(best) < LEAST else best)
    return found


def moved_by(steps: Sequence[Step]) -> list[str]:
    """The feeds and positions that change at so many of the steps as no chance makes it; those at the most of them."""
    counts = {n: [s for s in steps if n in s.beside] for n in dict.fromkeys(n for s in steps for n in s.beside)}
    axes = {n: some for n, some in counts.items() if _is_axis(some[0].test, n) and len(some) >= LEAST}
    most = max(map(len, axes.values()), default=0)
    return [n for n, some in axes.items() if len(some) == most and _by_chance(some, steps, n) <= CHANCE]


def _is_axis(test: TestData, name: str) -> bool:
    channel = test.channels.get(name)
    return channel is not None and channel.quantity in AXIS


def _by_chance(some: Sequence[Step], steps: Sequence[Step], name: str) -> float:
    """That so many of the steps, anywhere in their tests, fall beside changes of an axis."""
    span = max(float(np.nanmax(s.test.values[name]) - np.nanmin(s.test.values[name])) for s in some)
    shares = [float(_is_near_change(s.test, name, MOVED * span).mean()) for s in some]
    return math.comb(len(steps), len(some)) * math.prod(shares)


def _is_near_change(test: TestData, name: str, least: float) -> Bool1D:
    """The samples that are near to a change."""
    known = np.isfinite(test.values[name])
    times, values = test.t_s[known], test.values[name][known]
    changes = times[1:][np.abs(np.diff(values)) > least]
    near = np.searchsorted(changes, test.t_s + BESIDE_S, "right") > np.searchsorted(changes, test.t_s - BESIDE_S)
    return np.asarray(near)


def single(steps: Sequence[Step]) -> list[Step]:
    """The others: slips."""
    return _steps_outside(steps, repeating(steps))


def _with_the_way_back(best: Sequence[Step], rest: Sequence[Step]) -> list[Step]:
    if len(best) < LEAST:
        return list(best)
    back = -float(np.median([s.size for s in best]))
    return [s for s in rest if any(s is b for b in best) or _is_alike(s.size, back)]


def _most_alike(steps: Sequence[Step]) -> list[Step]:
    best: list[Step] = []
    for one in steps:
        middle = float(np.median([s.size for s in steps if _is_alike(s.size, one.size)]))
        alike = [s for s in steps if _is_alike(s.size, middle)]
        best = alike if len(alike) > len(best) else best
    return best


def _is_alike(size: float, other: float) -> bool:
    return abs(size - other) <= ALIKE * abs(other)


def _steps_outside(steps: Sequence[Step], groups: Sequence[Sequence[Step]]) -> list[Step]:
    return [s for s in steps if not any(s is a for group in groups for a in group)]


def as_artefacts(groups: Sequence[Sequence[Step]], unit: str) -> list[Artefact]:
    """One in each test in which they are, in the same words for one size. groups: of steps that repeat."""
    told: dict[tuple[str, str], list[str]] = {}
    for steps in groups:
        why = _why_repeating(steps, unit)
        for key in dict.fromkeys(s.test.key for s in steps):
            told.setdefault(key, []).append(why)
    return [
        Artefact(kind="repeated_step", campaign=c, test=t, at_s=None, size_um=None, why=". And ".join(whys))
        for (c, t), whys in told.items()
    ]


def _why_repeating(steps: Sequence[Step], unit: str) -> str:
    up, down = ([s.size for s in steps if (s.size > 0) is way] for way in (True, False))
    ends = [[f"{end(some, key=abs):+.1f}" for end in (min, max)] for some in (up, down) if some]
    sizes = " and ".join(" to ".join(dict.fromkeys(both)) for both in ends)
    axes = moved_by(steps)
    if axes and all(any(n in s.beside for n in axes) for s in steps):
        changes = f"{' and '.join(axes)} {'changes' if len(axes) == 1 else 'change'}"
        return (
            f"the displacement jumps {len(steps)} times, by {sizes} {unit} ({_at_hours(steps)}), each time just as "
            f"{changes}, and does not decay: jumps that come again and again as an axis starts or stops point to "
            "stick-slip or backlash of the machine, or to a body that moves with that axis and that nobody logs, "
            "whatever their size, for a probe slips at any time. Nothing was taken out for them"
        )
    by_clock = f"; {even}, as a programme has it" if (even := evenly(steps)) else ""
    ways, which = ("", "size and direction") if not (up and down) else (" to and fro", "size")
    return (
        f"the displacement jumps {len(steps)} times by the same amount{ways}, {sizes} {unit} ({_at_hours(steps)}), and "
        f"does not decay; {NOTHING_ELSEWHERE}: steps of one {which} that repeat point to "
        f"stick-slip or backlash of the machine, or to a body that nobody logs and that moves by one amount ({BODY}), "
        f"for a probe that slips does so by another amount each time{by_clock}. Nothing was taken out for them"
    )


def _at_hours(steps: Sequence[Step]) -> str:
    at: dict[str, list[str]] = {}
    for s in sorted(steps, key=lambda s: (s.test.key, s.at_s)):
        at.setdefault(s.test.test, []).append(f"{s.at_s / 3600:.1f}")
    return "; ".join(f"{test} at {', '.join(hours)} h" for test, hours in at.items())
