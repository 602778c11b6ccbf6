"""Two logs of one machine that disagree about the time, told by heat: a body warms when its drive works, not an hour
before.

What a command moves at once says when the displacement was measured (`clocks`), and nothing of a logger of
temperatures. So each temperature of one source is foretold by a heat balance with the commands of another, which are
moved until that is best: in all tests, then in one, as they act in the others unmoved.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass

from thermodata.diagnosis.commanded import is_command
from thermodata.diagnosis.heat_balance import UNMOVED_S, Disagreement, Pair, pair_of
from thermodata.schema.diagnosis import Artefact
from thermodata.view.dataset import ChannelInfo, TestData

# share of the squared rises of the response that commands foretell at the right time at least, and beyond the other one
DECIDES = 0.15


@dataclass(frozen=True, slots=True)
class Late:
    """A source whose clock is off: moved later by shift_s its log agrees with the others. source: None where nobody can
    tell which of the two it is."""

    source: str | None
    shift_s: float
    of: Disagreement


def late_logs(logs: Logs, right: Collection[str] = ()) -> list[Late]:
    """Of each source the plainest. right: sources whose clock is known to agree with that of the response."""
    return _plainest(logs, [d for d in logs.disagreements() if d.plain], lambda _: right)


def late_in_one(logs: Logs, right: Mapping[tuple[str, str], Collection[str]]) -> list[Late]:
    """Logs of single tests, as the others foretell them; of fewer than half of the tests, else nobody can say which
    are right. right: test -> sources whose clock is known there."""
    plain = [d for d in logs.in_one() if d.plain]
    found = _plainest(logs, plain, lambda d: right.get((d.campaign, d.test), frozenset()))
    return found if 2 * len({(f.of.campaign, f.of.test) for f in found}) < len(logs.tests) else []


def _plainest(
    logs: Logs, plain: Sequence[Disagreement], right: Callable[[Disagreement], Collection[str]]
) -> list[Late]:
    found: list[Late] = []
    for one in sorted(plain, key=lambda d: -d.share):
        of_test = [f.of for f in found if (f.of.campaign, f.of.test) == (one.campaign, one.test)]
        if not any({one.warmed, one.by} & {of.warmed, of.by} for of in of_test):
            found.append(logs.which(one, right(one)))
    return found


def as_artefact(late: Late, campaign: str) -> Artefact:
    of, known_to = late.of, UNMOVED_S / 60
    which = "one of the two clocks is off, and nothing tells which"
    if late.source is not None:
        which = f"the choice is made with '{late.source}' moved by {late.shift_s / 60:+.0f} min"
    by = "as they do in the other tests" if of.test else "in tests left out"
    where = f"clocks: {{{late.source or of.by}: ...}} at the test" if of.test else "clock: {offset: ...} at the source"
    return Artefact(
        kind="clock_offset",
        campaign=of.campaign or campaign,
        test=of.test,
        at_s=None,
        size_um=None,
        why=f"{of.telling} temperatures of source '{of.warmed}' follow the commands of source '{of.by}' best with "
        f"these moved by {of.shift_s / 60:+.0f} min (give or take {known_to:.0f}): {of.share:.0%} of their squared "
        f"rises are foretold {by}, unmoved {max(of.unmoved, 0.0):.0%}. So {which}; check the time zone "
        f"and the clocks, or declare what holds: {where}",
    )


@dataclass(frozen=True, slots=True)
class Logs:
    """The logs of some tests, each asked whether it agrees with the others about the time. step_s: of the tests' common
    grid."""

    tests: Sequence[TestData]
    channels: Mapping[str, ChannelInfo]
    response: str
    step_s: float
    pairs: tuple[Pair, ...] = ()

    def disagreements(self) -> list[Disagreement]:
        """Of each source of temperatures with each other source of commands, where its temperatures tell."""
        found = [pair.in_all() for pair in self.pairs]
        return [d for d in found if d is not None]

    def in_one(self) -> list[Disagreement]:
        """The same of each test, by the others."""
        found = [pair.in_one(i) for pair in self.pairs for i in range(len(pair.tests))]
        return [d for d in found if d is not None]

    def which(self, of: Disagreement, right: Collection[str]) -> Late:
        """The one that disagrees with the response, too: with its own clock, or with its own heat."""
        home = self.channels[self.response].source
        warmed, by = Late(of.warmed, -of.shift_s, of), Late(of.by, of.shift_s, of)
        if of.by == home or of.by in right:
            return warmed
        if of.warmed == home:
            return by
        drives = _of(_commands(self.channels), of.by)
        own = pair_of(self.tests, [self.response], drives, self.step_s, warmed=home or "", by=of.by)
        where_it_is, moved = (0.0, 0.0) if own is None else own.foretold(of.campaign, of.test, (0.0, of.shift_s))
        if max(where_it_is, moved) < DECIDES or abs(where_it_is - moved) < DECIDES:
            return Late(None, of.shift_s, of)
        return warmed if where_it_is > moved else by


def compared(tests: Sequence[TestData], channels: Mapping[str, ChannelInfo], response: str, step_s: float) -> Logs:
    """Each source of temperatures with each other source of commands."""
    failed = {n for t in tests for n, c in t.channels.items() if c.faulty is not None}
    warm = {n: c.source for n, c in channels.items() if c.quantity == "temperature" and n not in failed and c.source}
    commands, pairs = _commands(channels), []
    for by in sorted(set(commands.values())):
        for warmed in sorted(set(warm.values()) - {by}):
            names, drives = _of(warm, warmed), _of(commands, by)
            pairs.append(pair_of(tests, names, drives, step_s, warmed=warmed, by=by))
    return Logs(tests, channels, response, step_s, tuple(p for p in pairs if p is not None))


def _commands(channels: Mapping[str, ChannelInfo]) -> dict[str, str]:
    return {n: c.source for n, c in channels.items() if c.source and is_command(c)}


def _of(sources: Mapping[str, str], source: str) -> list[str]:
    return sorted(n for n, s in sources.items() if s == source)
