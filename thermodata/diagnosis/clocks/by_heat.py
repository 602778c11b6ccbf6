"""Two logs of one machine that disagree about the time, told by heat: a body warms when its drive works, not an hour
before.

What a command moves at once says when the displacement was measured (`by_commands`), and nothing of a logger of
temperatures. So each temperature of one source is foretold by a heat balance with the commands of another, which are
moved until that is best: in all tests, then in one, as they act in the others unmoved.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace

from thermodata.diagnosis.clocks.heat_balance import UNMOVED_S, Disagreement
from thermodata.diagnosis.clocks.logs_compared import Late, Logs
from thermodata.diagnosis.clocks.sides import Key, in_words
from thermodata.diagnosis.clocks.timings import what_to_declare
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.schema.words.sentences import in_percent


def late_logs(logs: Logs, right: Collection[str] = ()) -> list[Late]:
    """Of each source the plainest. right: sources whose clock is known to agree with that of the response.

    Where some tests tell that it is right in them, it is so in a part of the tests.
    """
    found = _plainest_late(logs, [d for d in logs.disagreements() if d.plain], lambda _: right)
    return [late for one in found if (late := logs.in_part(one, lambda _: right)) is not None]


def late_in_one(logs: Logs, right: Mapping[Key, Collection[str]]) -> list[Late]:
    """Logs of single tests, as the others foretell them; of fewer than half of the tests, else nobody can say which
    are right. Two and more that are off alike are a part of the tests, however many.

    right: test -> sources whose clock is known there.
    """

    def known(key: Key) -> Collection[str]:
        return right.get(key, frozenset())

    plain = [d for d in logs.in_one() if d.plain]
    found: list[Late] = []
    for one in [*sorted(plain, key=lambda d: -d.share), *logs.likely()]:
        if not any({one.warmed, one.by} & {f.of.warmed, f.of.by} for f in found):
            together = logs.in_part(Late(None, one.shift_s, replace(one, campaign="", test="")), known)
            found += [together] if together is not None and together.part is not None else []
    inside = {key for f in found if f.part is not None for key in f.part.off}
    single = _plainest_late(logs, [d for d in plain if d.key not in inside], lambda d: known(d.key))
    return found + (single if 2 * len({f.of.key for f in single}) < len(logs.tests) else [])


def _plainest_late(
    logs: Logs, plain: Sequence[Disagreement], right: Callable[[Disagreement], Collection[str]]
) -> list[Late]:
    found: list[Late] = []
    for one in sorted(plain, key=lambda d: -d.share):
        of_test = [f.of for f in found if f.of.key == one.key]
        if not any({one.warmed, one.by} & {of.warmed, of.by} for of in of_test):
            found.append(logs.which(one, right(one)))
    return found


def as_artefact(late: Late, campaign: str) -> Artefact:
    """Of a part of the tests the first one is named as its place."""
    of, part, known_to = late.of, late.part, UNMOVED_S / 60
    first = of.key if part is None else part.off[0]
    which = "one of the two clocks is off, and nothing tells which"
    if late.source is not None:
        which = f"the choice is made with '{late.source}' moved by {late.shift_s / 60:+.0f} min"
        which += " in these tests" if part else ""
    by = "as they do in the other tests" if first[1] else "in tests left out"
    tests = "" if not first[1] else "these tests" if part else "the test"
    declare = (
        f"Declare what holds at {tests}, clocks: {{{of.by}: ..., {of.warmed}: ...}}, 0 s for one that was right"
        if tests
        else "Declare what holds at both sources, clock: {offset: ...}, 0 s for the one that is right"
    )
    if late.source is not None:
        declare = what_to_declare(late.source, late.shift_s, tests)
    return Artefact(
        kind="clock_offset",
        campaign=first[0] or campaign,
        test=first[1],
        at_s=None,
        size_um=None,
        why=f"{of.telling} temperatures of source '{of.warmed}' follow the commands of source '{of.by}' best with "
        f"these moved by {of.shift_s / 60:+.0f} min (give or take {known_to:.0f}){in_words(part)}: "
        f"{in_percent(of.share)} of "
        f"their squared rises are foretold {by}, unmoved {in_percent(max(of.unmoved, 0.0))}. So {which}; check the "
        f"time zone and the clocks. {declare}",
    )
