"""One rule of when is measured for all tests that move alike: what some tell exactly holds for those whose probes were
seen to leave their range too seldom, or with a row between; which differ is said."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.draft.courses.beside import SignalBeside, signals_beside
from thermodata.draft.courses.measuring import Measuring
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.probes.out_of_range import out_of_range
from thermodata.draft.times.clocks import Named
from thermodata.draft.times.one_clock import OneClock
from thermodata.plugin import Bool1D, Float1D
from thermodata.schema.words.sentences import with_count

_NUMBER = r"-?\d[\d.e+-]*"
_TERM = re.compile(rf"abs\((\w+) - ({_NUMBER})\) < ({_NUMBER})|(\w+) == ({_NUMBER})")
_RIGHT = 0.95  # of the rows, or a test is one that differs
_FEWEST = 4  # changes between measuring and not
_ALIKE = 2.0  # as often, as a factor
_SHOWN = 4


@dataclass(frozen=True, slots=True)
class _Holds:
    """A rule at the rows of a test's probe. holds: shape (n,), where the test tells it for sure; out: where the probe
    is out of its range, None where it never is."""

    holds: Bool1D
    out: Bool1D | None

    @property
    def share(self) -> float:
        return float(self.holds.mean())

    @property
    def right(self) -> float:
        """The share of the rows in which the rule says whether the probe is in range."""
        return 1.0 if self.out is None else float((self.holds != self.out).mean())

    def moves_as(self, others: Sequence[_Holds]) -> bool:
        usual = float(np.median([o.share for o in others]))
        often = np.count_nonzero(np.diff(self.holds)) >= _FEWEST
        return bool(often) and usual / _ALIKE <= self.share <= usual * _ALIKE


def same_rules(
    rules: Mapping[str, Measuring | None],
    recordings: Mapping[str, Sequence[RawFile]],
    named: Mapping[int, Named],
    clocks: Mapping[int, OneClock],
) -> tuple[dict[str, Measuring | None], dict[str, str]]:
    """(test -> its rule, test -> what is asked of one that differs). named, clocks: as `rule_of` has them."""
    made, asked = dict(rules), dict[str, str]()
    shapes = Counter(_shape(rule.when) for rule in rules.values() if rule is not None)
    if not shapes:
        return made, asked
    shape = shapes.most_common(1)[0][0]
    own = {t: r.when for t, r in rules.items() if r is not None and _shape(r.when) == shape}
    usual = Counter(own.values()).most_common(1)[0][0]
    having = [t for t, when in own.items() if when == usual]
    seen = {t: h for t in rules if (h := _holds(usual, recordings[t], named, clocks)) is not None}
    others = [seen[t] for t in having if t in seen]
    for test, rule in rules.items():
        here = seen.get(test)
        if here is None or not others or (rule is not None and rule.when == usual):
            continue
        as_in = with_count(having, _SHOWN)
        if rule is None and not here.moves_as(others):
            continue
        if rule is not None and (test not in own or here.right < _RIGHT):
            asked[test] = f"measuring: otherwise than in {as_in}, where it is {usual}"
        elif here.right < _RIGHT:
            otherwise = f"{'out of' if _too_often(here) else 'in'} range in {100 * (1 - here.right):.0f} % of the rows"
            asked[test] = (
                f"measuring: {usual} as in {as_in}? the axes move alike, but here the probes are {otherwise} otherwise"
            )
        else:
            made[test] = Measuring(usual, f"as in {as_in}, which move alike")
    return made, asked


def _too_often(here: _Holds) -> bool:
    return here.out is not None and bool((here.holds & here.out).sum() > (~here.holds & ~here.out).sum())


def _shape(when: str) -> str:
    """A rule without its numbers: the channels that it reads, and how."""
    return re.sub(rf"(?<=[ (]){_NUMBER}", "#", when)


def _holds(
    when: str, files: Sequence[RawFile], named: Mapping[int, Named], clocks: Mapping[int, OneClock]
) -> _Holds | None:
    """Where a rule holds in a test; None where it lacks a channel of it, or a displacement of the tool."""
    for file in files:
        for key, course in file.sample.courses.items():
            if named.get(id(file), {}).get(key, ("", None, ""))[:2] != ("displacement", "tcp") or not course.t_ns.size:
                continue
            for signals in signals_beside(files, named, file, course.t_ns, clocks):
                told = _told(when, {s.channel: s for s in signals})
                if told is None:
                    continue
                holds, sure = told
                out = out_of_range(course.values)
                if sure.any():
                    return _Holds(holds[sure], None if out is None else out[sure])
    return None


def _told(when: str, signals: Mapping[str, SignalBeside]) -> tuple[Bool1D, Bool1D] | None:
    """(where all terms of a rule hold, where that is sure); None where a channel is not there."""
    told: tuple[Bool1D, Bool1D] | None = None
    for near, middle, limit, at, level in _TERM.findall(when):
        signal = signals.get(near or at)
        if signal is None:
            return None
        holds, sure = signal.told(_near(float(middle), float(limit)) if near else _at(float(level)))
        told = (holds, sure) if told is None else (told[0] & holds, told[1] & sure)
    return told


def _near(middle: float, limit: float) -> Callable[[Float1D], Bool1D]:
    def rule(x: Float1D) -> Bool1D:
        return np.asarray(np.abs(x - middle) < limit)

    return rule


def _at(level: float) -> Callable[[Float1D], Bool1D]:
    def rule(x: Float1D) -> Bool1D:
        return np.asarray(x == level)

    return rule
