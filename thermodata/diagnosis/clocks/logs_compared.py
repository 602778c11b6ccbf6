"""The logs of some tests compared by heat: where the temperatures of one source and the commands of another disagree
about the time, in which of the tests, and which of the two clocks is off."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from thermodata.diagnosis.clocks.heat_balance import LEAST_TELLING, UNMOVED_S, Disagreement, Pair, pair_of
from thermodata.diagnosis.clocks.sides import Key, ShiftedPart, either, in_order, own_shifts, part_of, sides
from thermodata.diagnosis.steps.commanded import is_command
from thermodata.effect.places import holds
from thermodata.schema.answers.diagnosis import ClockMoved
from thermodata.schema.words.places import AROUND
from thermodata.view.grid.dataset import ChannelInfo, TestData

# share of the squared rises of the response that commands foretell at the right time at least, and beyond the other one
DECIDES = 0.15
# of what heat moves, where logs begin and end elsewhere in some tests: clocks that were right left 0.71 to 1.6 of it
# with a log moved by 25 min, and wrong ones 0.17, 0.37, 0.62 and 1.16 (machines made outside)
MOST_LEFT = 2 / 3
LEAST_OFF = 2  # tests that tell a shift in a part of them


@dataclass(frozen=True, slots=True)
class Late:
    """A source whose clock is off: moved later by shift_s its log agrees with the others. source: None where nobody can
    tell which of the two it is. part: the tests in which it is, where it is right in others; None: in `of.test`, or in
    all."""

    source: str | None
    shift_s: float
    of: Disagreement
    part: ShiftedPart | None = None

    @property
    def tests(self) -> Sequence[Key]:
        """In which it is; test '': in all."""
        return [self.of.key] if self.part is None else self.part.off

    def moves(self) -> list[ClockMoved]:
        """What puts it right; nothing where nobody can tell what would."""
        if self.source is None:
            return []
        return [ClockMoved(source=self.source, campaign=c, test=t, moved_s=self.shift_s) for c, t in self.tests]


@dataclass(frozen=True, slots=True)
class Logs:
    """The logs of some tests, each asked whether it agrees with the others about the time. step_s: of the tests' common
    grid. with_locked: the pairs with the locked tests, too, of which the response is not asked. order: of all of them.
    declared: test -> sources whose clock somebody declared in it."""

    tests: Sequence[TestData]
    channels: Mapping[str, ChannelInfo]
    response: str
    step_s: float
    pairs: tuple[Pair, ...] = ()
    with_locked: tuple[Pair, ...] = ()
    order: tuple[Key, ...] = ()
    declared: Mapping[Key, Collection[str]] = field(default_factory=dict)

    def disagreements(self) -> list[Disagreement]:
        """Of each source of temperatures with each other source of commands, where its temperatures tell."""
        found = [pair.in_all() for pair in self.pairs]
        return [d for d in found if d is not None]

    def in_one(self) -> list[Disagreement]:
        """The same of each test, by the others."""
        found = [pair.in_one(i) for pair in self.pairs for i in range(len(pair.tests))]
        return [d for d in found if d is not None]

    def in_part(self, late: Late, known: Callable[[Key], Collection[str]]) -> Late | None:
        """The same in the tests that it is told of, where others tell that it is right in them; None where only these
        tell. known: test -> sources whose clock is known there."""
        of = late.of
        pair = next(p for p in self.with_locked if (p.warmed, p.by) == (of.warmed, of.by))
        told = sides(pair, of.shift_s)
        declared = {key for key in self.order if {of.warmed, of.by} & set(self.declared.get(key, ()))}
        off, right = told.off - declared, told.right - declared
        if not right and not declared:
            return late
        if not off:
            return None
        part = part_of([key for key in self.order if key not in declared], off, right)
        unmoved, moved = told.of_off()
        found = replace(of, shift_s=told.apart_s(), unmoved=unmoved, share=moved)
        if len(off) < LEAST_OFF or not found.plain:
            return None
        known_there = {source for key in part.off for source in known(key)}
        which = self.which(found, known_there, off)
        return replace(which, source=which.source if part.plain else None, part=part)

    def likely(self) -> list[Disagreement]:
        """Shifts that single tests tell by gains of their own, where the others, being off as well, tell none."""
        return [
            Disagreement(p.warmed, p.by, by_s, 0.0, 0.0, LEAST_TELLING) for p in self.pairs for by_s in own_shifts(p)
        ]

    def own(self, by: str) -> Pair | None:
        """The response, and the commands of a source."""
        drives, home = _names_of_source(_commands(self.channels), by), self.channels[self.response].source
        air = sorted(n for n, c in self.channels.items() if is_around(c) and c.source not in ("", by))
        return pair_of(self.tests, [self.response], drives, self.step_s, warmed=home or "", by=by, air=air)

    def bears_out(self, clocks: Sequence[ClockMoved]) -> bool:
        """Whether far less is left of what heat moves with a log moved in some tests than where it stands: of the
        response by its commands, and of the temperatures of either log by the commands of the other.

        clocks: of one source, by one shift.
        """
        source, by_s, off = clocks[0].source, clocks[0].moved_s, {(c.campaign, c.test) for c in clocks}
        home = self.channels[self.response].source
        own = self.own(source) if source in _commands(self.channels).values() else None
        both = [p for p in self.pairs if {p.warmed, p.by} == {source, home}]
        left = [_share_left(p, by_s if p.by == source else -by_s, off) for p in filter(None, [own, *both])]
        return bool(left) and float(np.prod(left)) <= MOST_LEFT

    def comes_as_logged(self, source: str, key: Key, shift_s: float) -> bool:
        """Whether heat says of a test that the clock of a source is right in it, and by no such shift off: what another
        log measured warms as it commands where it stands, and not with the commands moved.

        Where the response, by its own heat, says that it is off, it is the response's own clock that is, and the one of
        the temperatures goes with that of the commands.
        """
        own = self.own(source)
        if own is not None and _can_be_asked(own, key, shift_s):
            where_it_is, moved = either(own, shift_s, [key])
            if moved >= DECIDES and moved - where_it_is >= DECIDES:
                return False
        return any(
            key in sides(pair, shift_s).right
            for pair in self.pairs
            if pair.by == source and _can_be_asked(pair, key, shift_s)
        )

    def which(self, of: Disagreement, right: Collection[str], off: Collection[Key] = ()) -> Late:
        """The one that disagrees with the response, too: with its own clock, or with its own heat. off: the tests in
        which they disagree, where that is a part of them."""
        home = self.channels[self.response].source
        warmed, by = Late(of.warmed, -of.shift_s, of), Late(of.by, of.shift_s, of)
        if of.by == home or of.by in right:
            return warmed
        if of.warmed == home:
            return by
        own = self.own(of.by)
        where_it_is, moved = 0.0, 0.0
        if own is not None:
            near = (0.0, of.shift_s)
            where_it_is, moved = either(own, of.shift_s, off) if off else own.foretold(of.campaign, of.test, near)
        if max(where_it_is, moved) < DECIDES or abs(where_it_is - moved) < DECIDES:
            return Late(None, of.shift_s, of)
        return warmed if where_it_is > moved else by


def compared(
    tests: Sequence[TestData],
    channels: Mapping[str, ChannelInfo],
    response: str,
    step_s: float,
    *,
    locked: Sequence[TestData] = (),
    declared: Mapping[Key, Collection[str]] | None = None,
) -> Logs:
    """Each source of temperatures with each other source of commands. locked: tests whose response stays unread.
    declared: as in `Logs`."""
    every = [*tests, *locked]
    failed = {n for t in tests for n, c in t.channels.items() if c.faulty is not None}
    both = _pairs(every, channels, step_s, failed)
    pairs = tuple(own for pair in both if (own := pair.of(tests)) is not None)
    return Logs(tests, channels, response, step_s, pairs, both, tuple(in_order(every)), declared or {})


def _pairs(
    tests: Sequence[TestData], channels: Mapping[str, ChannelInfo], step_s: float, failed: Collection[str]
) -> tuple[Pair, ...]:
    """failed: temperatures that say nothing, as they stood in the open tests: the pairs are the same with locked ones,
    where what is flagged says nothing of itself."""
    every = {n: c.source for n, c in channels.items() if c.quantity == "temperature" and n not in failed and c.source}
    around = {n: s for n, s in every.items() if is_around(channels[n])}
    warm = {n: s for n, s in every.items() if n not in around}
    commands, pairs = _commands(channels), []
    for by in sorted(set(commands.values())):
        air = sorted(n for n, s in around.items() if s != by)
        for warmed in sorted(set(warm.values()) - {by}):
            names, drives = _names_of_source(warm, warmed), _names_of_source(commands, by)
            pairs.append(pair_of(tests, names, drives, step_s, warmed=warmed, by=by, air=air))
    return tuple(p for p in pairs if p is not None)


def _can_be_asked(pair: Pair, key: Key, shift_s: float) -> bool:
    """Whether enough of a test is left with the commands moved, so that heat can say which of two times is right."""
    near = np.abs(pair.shifts_s - shift_s) <= UNMOVED_S
    return any(
        t.key == key and bool((energy[:, near] > 0).any()) for t, energy in zip(pair.tests, pair.energy, strict=True)
    )


def _share_left(pair: Pair, shift_s: float, off: set[Key]) -> float:
    """What is left of tests with the commands moved, in shares of what is left with them where they are; 1 where that
    is not asked."""
    if off.isdisjoint(t.key for t in pair.tests) or np.abs(pair.shifts_s - shift_s).min() > UNMOVED_S:
        return 1.0
    unmoved, moved = either(pair, shift_s, off)
    return (1 - moved) / max(1 - unmoved, 1e-300)


def is_around(info: ChannelInfo) -> bool:
    """Whether it is a temperature of the hall, its floor, or the weather: no drive of the machine warms these."""
    return info.quantity == "temperature" and any(holds(place, info.at) for place in AROUND)


def _commands(channels: Mapping[str, ChannelInfo]) -> dict[str, str]:
    return {n: c.source for n, c in channels.items() if c.source and is_command(c)}


def _names_of_source(sources: Mapping[str, str], source: str) -> list[str]:
    return sorted(n for n, s in sources.items() if s == source)
