"""Steps of one size that repeat: the machine makes them, and no probe.

A probe or fixture that slips does so by another amount each time. What sticks and slips, or has play, gives way by one
amount again and again. Between its jumps it keeps back what it should do, and catches up in them: levels with a free
offset each would take the motion for none. So such steps are told together, and the course stays whole.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.steps.artefact import Step
from thermodata.schema.diagnosis import Artefact

LEAST = 3  # of two that are alike by chance there are many
ALIKE = 0.1  # of their median, that each differs from it by at most


def repeating(steps: Sequence[Step]) -> list[list[Step]]:
    """Those of all tests that are alike, where there are so many in one direction, and with them those by which it goes
    back: play is passed through both ways. A list for each size, the most frequent first."""
    found: list[list[Step]] = []
    while len(best := _most_alike(rest := _without(steps, found))) >= LEAST:
        back = -float(np.median([s.size for s in best]))
        found.append([s for s in rest if any(s is b for b in best) or _is_alike(s.size, back)])
    return found


def single(steps: Sequence[Step]) -> list[Step]:
    """The others: slips."""
    return _without(steps, repeating(steps))


def _most_alike(steps: Sequence[Step]) -> list[Step]:
    best: list[Step] = []
    for one in steps:
        middle = float(np.median([s.size for s in steps if _is_alike(s.size, one.size)]))
        alike = [s for s in steps if _is_alike(s.size, middle)]
        best = alike if len(alike) > len(best) else best
    return best


def _is_alike(size: float, other: float) -> bool:
    return abs(size - other) <= ALIKE * abs(other)


def _without(steps: Sequence[Step], groups: Sequence[Sequence[Step]]) -> list[Step]:
    return [s for s in steps if not any(s is a for group in groups for a in group)]


def as_artefacts(groups: Sequence[Sequence[Step]], unit: str) -> list[Artefact]:
    """One in each test in which they are, in the same words for one size. groups: of steps that repeat."""
    told: dict[tuple[str, str], list[str]] = {}
    for steps in groups:
        why = _why(steps, unit)
        for key in dict.fromkeys(s.test.key for s in steps):
            told.setdefault(key, []).append(why)
    return [
        Artefact(kind="repeated_step", campaign=c, test=t, at_s=None, size_um=None, why=". And ".join(whys))
        for (c, t), whys in told.items()
    ]


def _why(steps: Sequence[Step], unit: str) -> str:
    up, down = ([s.size for s in steps if (s.size > 0) is way] for way in (True, False))
    ends = [[f"{end(some, key=abs):+.1f}" for end in (min, max)] for some in (up, down) if some]
    sizes = " and ".join(" to ".join(dict.fromkeys(both)) for both in ends)
    ways, which = ("", "size and direction") if not (up and down) else (" to and fro", "size")
    return (
        f"the displacement jumps {len(steps)} times by the same amount{ways}, {sizes} {unit} ({_where(steps)}), and "
        f"does not decay; no speed, feed or switch does that elsewhere: steps of one {which} that repeat point to "
        "stick-slip or backlash of the machine, for a probe that slips does so by another amount each time. Nothing "
        "was taken out for them"
    )


def _where(steps: Sequence[Step]) -> str:
    at: dict[str, list[str]] = {}
    for s in sorted(steps, key=lambda s: (s.test.key, s.at_s)):
        at.setdefault(s.test.test, []).append(f"{s.at_s / 3600:.1f}")
    return "; ".join(f"{test} at {', '.join(hours)} h" for test, hours in at.items())
