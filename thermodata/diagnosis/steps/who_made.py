"""Whether a step that goes with nothing logged is like a slip, or like a body that nobody logs and that moved.

A probe slips once, by any amount, at any time. An indexing table or a clamp goes to and fro, by amounts of its own, as
a programme says. What is known of one step alone is too little to tell them apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, pairwise

from thermodata.diagnosis.steps.step import Step

BODY = "an indexing table or a clamp, say"
ALIKE = 0.1  # of a size, that another one differs from it by at most
CHANCE = 0.05  # that slips at any time come so evenly, or at one time of several tests
LEAST_S = 1.0  # to which moments are known, where nobody said how long a step takes


def which(step: Step, steps: Sequence[Step]) -> str:
    """What of all that was found speaks for a body or for a slip, in words. steps: all of all tests, this one too."""
    own = sum(s.test.key == step.test.key for s in steps)
    even = evenly(steps) if own > 1 else ""
    signs = [sign for sign in (_back_at(step, steps), even, _as_elsewhere(step, steps)) if sign]
    if signs:
        return f"{' and '.join(signs)}, which speaks for a body that moved"
    alike = _as_large_as(step, steps)
    if alike is not None:
        where = f" in {alike.test.test}" if alike.test.key != step.test.key else ""
        return f"that{where} at {_hours(alike)} is as large, which a body repeats, and two slips are by chance"
    if len(steps) > 1:
        return "no other jump takes it back or is as large, and no programme shows in when they come: so do slips"
    return (
        "it is the only jump of these tests, and its level does not come back: so does a slip, and so does a body that "
        "moved once"
    )


def evenly(steps: Sequence[Step]) -> str:
    """'the jumps come every 60 min, or a multiple of it', where several in one test do by no chance; else ''."""
    times: dict[tuple[str, str], list[float]] = {}
    for s in sorted(steps, key=lambda s: s.at_s):
        times.setdefault(s.test.key, []).append(s.at_s)
    gaps = [b - a for at in times.values() for a, b in pairwise(at)]
    if len(gaps) < 2:
        return ""
    every, known = min(gaps), _known_to(steps)
    if every <= 2 * known or any(abs(gap - every * round(gap / every)) > known for gap in gaps):
        return ""
    # one of them says how far apart; each other is as near to a multiple of it
    if (2 * known / every) ** (len(gaps) - 1) > CHANCE:
        return ""
    multiple = "" if max(gaps) < 1.5 * every else ", or a multiple of it"
    return f"the jumps come every {every / 60:.0f} min{multiple}"


def _back_at(step: Step, steps: Sequence[Step]) -> str:
    """Whether it and others of its test together leave the level as it was, in words; else ''."""
    own = sorted((s for s in steps if s.test.key == step.test.key), key=lambda s: s.at_s)
    place = next((i for i, s in enumerate(own) if s is step), 0)
    runs = ((i, j) for j in range(place, len(own)) for i in range(place + 1) if i < j)
    found = next(((i, j) for i, j in runs if _sizes_cancel([s.size for s in own[i : j + 1]])), None)
    if found is None:
        return ""
    first, last = found
    if last == place:
        return f"it brings back the level of before {_hours(own[first])}"
    return f"the level of before {'it' if first == place else _hours(own[first])} comes back at {_hours(own[last])}"


def _sizes_cancel(sizes: Sequence[float]) -> bool:
    return abs(sum(sizes)) <= ALIKE * max(map(abs, sizes))


def _as_elsewhere(step: Step, steps: Sequence[Step]) -> str:
    """Whether it comes at one time of its test and of others, by no chance."""
    known = _known_to(steps)
    tests = {s.test.key: s.test for s in steps}
    pairs = sum(a.test.key != b.test.key for a, b in combinations(steps, 2))
    shortest = min(float(t.t_s[-1] - t.t_s[0]) for t in tests.values())
    with_it = [s for s in steps if s.test.key != step.test.key and abs(s.at_s - step.at_s) <= known]
    if not with_it or pairs * 2 * known > CHANCE * shortest:
        return ""
    names = list(dict.fromkeys(s.test.test for s in with_it))
    return f"{' and '.join(names)} {'has' if len(names) == 1 else 'have'} one at the same time from the start"


def _as_large_as(step: Step, steps: Sequence[Step]) -> Step | None:
    others = (s for s in steps if s is not step and abs(abs(s.size) - abs(step.size)) <= ALIKE * abs(step.size))
    return min(others, key=lambda s: (s.test.key != step.test.key, s.test.key, s.at_s), default=None)


def _known_to(steps: Sequence[Step]) -> float:
    """How well their moments are known [s]."""
    return max(LEAST_S, max((s.within_s for s in steps), default=0.0))


def _hours(step: Step) -> str:
    return f"{step.at_s / 3600:.1f} h"
