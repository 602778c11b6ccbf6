"""Steps of one size and direction that repeat: the machine makes them, and no probe.

A probe or fixture that slips does so by another amount each time. What sticks and slips, or has play, gives way by one
amount again and again. Between its jumps it keeps back what it should do, and catches up in them: levels with a free
offset each would take the motion for none. So such steps are told together, and the course stays whole.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.diagnosis.artefact import Step
from thermodata.schema.diagnosis import Artefact

LEAST = 3  # of two that are alike by chance there are many
ALIKE = 0.1  # of their median, that each differs from it by at most


def repeating(steps: Sequence[Step]) -> list[Step]:
    """Those of all tests that are alike, where there are so many."""
    best: list[Step] = []
    for one in steps:
        alike = [s for s in steps if abs(s.size - one.size) <= ALIKE * abs(one.size)]
        middle = float(np.median([s.size for s in alike]))
        alike = [s for s in steps if abs(s.size - middle) <= ALIKE * abs(middle)]
        best = alike if len(alike) > len(best) else best
    return best if len(best) >= LEAST else []


def single(steps: Sequence[Step]) -> list[Step]:
    """The others: slips."""
    again = repeating(steps)
    return [s for s in steps if not any(s is a for a in again)]


def as_artefacts(steps: Sequence[Step], unit: str) -> list[Artefact]:
    """One in each test in which they are, in the same words. steps: that repeat."""
    if not steps:
        return []
    sizes = [s.size for s in steps]
    why = (
        f"the displacement jumps {len(steps)} times by the same amount, {min(sizes, key=abs):+.1f} to "
        f"{max(sizes, key=abs):+.1f} {unit} ({_where(steps)}), and does not decay; no speed, feed or switch does that "
        "elsewhere: steps of one size and direction that repeat point to stick-slip or backlash of the machine, for a "
        "probe that slips does so by another amount each time. Nothing was taken out for them"
    )
    tests = dict.fromkeys(s.test.key for s in steps)
    return [Artefact(kind="repeated_step", campaign=c, test=t, at_s=None, size_um=None, why=why) for c, t in tests]


def _where(steps: Sequence[Step]) -> str:
    at: dict[str, list[str]] = {}
    for s in sorted(steps, key=lambda s: (s.test.key, s.at_s)):
        at.setdefault(s.test.test, []).append(f"{s.at_s / 3600:.1f}")
    return "; ".join(f"{test} at {', '.join(hours)} h" for test, hours in at.items())
