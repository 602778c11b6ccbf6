"""The advice where nothing could be claimed: more tests, a channel to ask by itself, or a sensor that is not there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from thermodata.diagnosis.question.problem import MIN_ROWS
from thermodata.diagnosis.tell.advising.bare import to_log
from thermodata.diagnosis.tell.advising.worked import Worked
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.answers.diagnosis import WeakSpot
from thermodata.schema.words.sentences import counted, listed
from thermodata.view.grid.dataset import ChannelInfo

# share of machines whose one missing cause was named, by number of open tests: of the lathe, where most tests work all
# parts (sealed seeds; docs/derivations.md), and of 54 worlds whose tests work one source each
ALL_AT_ONCE = ((3, "72 %"), (8, "86 %"), (16, "80 %"))
ONE_EACH = ((3, "36 %"), (8, "83 %"))
ENOUGH_TESTS = 8
FEW_TESTS = 3  # so few, and the shares say what more of them would give
# of the squared error, on left-out tests: what a channel must give to be named before a sensor that is not there
WORTH_A_TEST = 0.3


def to_find(
    tests: int,
    spots: Sequence[WeakSpot],
    channels: Mapping[str, ChannelInfo],
    first: Scored | None = None,
    sources: Worked | None = None,
) -> str:
    """The advice where nothing could be claimed. tests: those that took part; spots: where the model fails most.
    first: the candidate that ranks first, whose channels are logged and are no advice to log; sources: what the tests
    work by itself."""
    sources = sources or Worked()
    if tests == 0:
        return (
            f"no test took part, for none has {MIN_ROWS} samples at the model's step: longer tests, or a shorter step "
            "in the model"
        )
    gives = first is not None and first.drop >= WORTH_A_TEST
    log = to_log(first, channels) if first is not None and gives else None
    if tests < ENOUGH_TESTS:
        return "; ".join(filter(None, [log, _more_tests(tests, sources)]))
    took_part = f"{counted(tests, 'test')} took part, so more of the same will not tell"
    if log is not None:
        return f"{took_part}; {log}"
    logged = _by_what_is_logged(first, channels, sources) if first is not None and gives else ""
    if not logged and spots and spots[0].after_warm_start:
        return (
            f"{took_part}: the model fails most in "
            f"{spots[0].test}, {spots[0].state}, and what was warm before is in no log of it: run it again from a cold "
            "start"
        )
    return (
        f"{took_part}: {logged}log what is not logged "
        f"yet near the parts that work where the model fails most{_where_error_is(spots)}"
    )


def _more_tests(tests: int, sources: Worked) -> str:
    """Where these are few: what others are to work. tests: those that took part."""
    add = _one_source_each(sources)
    if tests > FEW_TESTS:
        return f"{counted(tests, 'test')} took part; {add}: no other test foretells what acts in one alone"
    all_at_once, one_each = (listed([f"{share} with {n}" for n, share in some]) for some in (ALL_AT_ONCE, ONE_EACH))
    return (
        f"{counted(tests, 'test')} took part; what they move counts more than how many they are: on simulated "
        f"machines a missing cause was named in {all_at_once} tests where most of them work all parts, and in "
        f"{one_each} where each works one, for no other test foretells what acts in one alone. So {add}"
    )


def _by_what_is_logged(first: Scored, channels: Mapping[str, ChannelInfo], sources: Worked) -> str:
    """How the candidate that ranks first is asked by its own channels, as the beginning of a sentence."""
    if first.candidate.protocol is not None:
        return f"do {first.candidate.protocol}; if nothing differs, "
    of = first.candidate.channels
    are, rank, them = ("is", "ranks", "it") if len(of) == 1 else ("are", "rank", "them")
    closed = first.looked is None
    opened = f", or open the locked tests for {first.candidate.id} (thermodata confirm)" if closed else ""
    there = sources.tests_of([channels[c] for c in of if c in channels])
    alone = f"run a test that moves {them} alone{opened}"
    if there:
        alone = f"repeat {listed(there, 'or')}, where what moves {them} works alone, or run it longer{opened}"
    return f"{listed(of)} {are} logged and {rank} first, so {alone}; if it is not that, "


def _where_error_is(spots: Sequence[WeakSpot]) -> str:
    """', which is in mix from 2.0 h to 3.5 h (speed 0 to 226 rpm)': states are what parts work by, and no parts."""
    if not spots:
        return " (in no state in particular)"
    worst = spots[0]
    hours = f"from {worst.from_s / 3600:.1f} h to {worst.to_s / 3600:.1f} h"
    return f", which is in {worst.test} {hours} (then: {worst.state})"


def _one_source_each(sources: Worked) -> str:
    """What tests to add, where there are few."""
    lacking = sources.lacking()
    if not sources.acts:
        return "add tests until each source (spindle, one axis, table, hall air) acts in two at least"
    if not lacking:
        worked = listed([s for s in sources.acts if sources.alone.get(s)])
        several = "add tests that work several, until each acts in two at least"
        return f"{worked} are worked alone in a test already, so {several}"
    once = [s for s in lacking if sources.alone.get(s)]
    never = [s for s in lacking if s not in once]
    acts = "acts" if len(once) == 1 else "act"
    lacks = [
        f"none works {listed(never, 'or')} alone yet" if never else "",
        f"{listed(once)} {acts} in one only" if once else "",
    ]
    return f"add tests until each source acts in two at least ({'; '.join(filter(None, lacks))})"
