"""Several probes along one axis: each jump test moves all of them, and each probe has one of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from thermodata.draft.probes.jumps import JumpTest, Moved
from thermodata.draft.words.naming import words


def each_its_own(jumps: Sequence[JumpTest]) -> list[JumpTest]:
    """The jump tests in their order. Where two are of the probe that moved most, and another that moved with it has
    none, the one whose file is called more like that is its."""
    made = list(jumps)
    for probe in dict.fromkeys(j.signal for j in jumps if j.signal is not None):
        for name in dict.fromkeys(o.signal for j in jumps if j.signal == probe for o in j.others):
            same = [i for i, j in enumerate(made) if j.signal == probe]
            having = {i: o for i in same for o in made[i].others if o.signal == name}
            if len(same) < 2 or not having or any(j.signal == name for j in made):
                continue
            best = max(having, key=lambda i: _alike(made[i], name) - _alike(made[i], probe))
            its, jump = having[best], made[best]
            beside = [o for o in jump.others if o is not its]
            if jump.signal is not None:
                beside.append(Moved(jump.signal, jump.steps, jump.dwell_s))
            made[best] = replace(jump, signal=name, steps=its.steps, dwell_s=its.dwell_s, others=tuple(beside))
    return made


def _alike(jump: JumpTest, signal: tuple[str, str]) -> float:
    """The share of the words of a signal's name that stand in the name of the jump test's file."""
    own, there = set(words(signal[1]).split()), set(words(jump.file.path.stem).split())
    return len(own & there) / max(len(own), 1)
