"""What the commands of a source say of its clock, by what they move at once: whether it is off, and in which tests."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from thermodata.diagnosis.clocks.sides import Key, ShiftedPart, in_words, part_of
from thermodata.diagnosis.question.problem import Problem
from thermodata.schema.answers.diagnosis import Artefact, ClockMoved
from thermodata.schema.words.sentences import in_percent

MOST_S = 1800.0  # shifts that are asked, either way,
HOURS, ABOUT_S = (1, 2), 300.0  # and whole hours, give or take: a time zone, or daylight saving,
LEAST_SHARE = 0.1  # of the squared jumps, which the other tests foretell at the best shift
BEATS = 2.0  # times what they foretell unmoved
LEAST_S = 150.0  # quick heat is late by up to 2 min where clocks are right
GIVE_OR_TAKE = 2  # samples between the shift found and the right one, at most
CHANCE = 0.005  # that one of all shifts of a test stands out so far where no clock is off


@dataclass(frozen=True, slots=True)
class Timing:
    """shift_s: by which a source's commands foretell most when moved later; of one test beyond what all are moved by.
    share: of the squared jumps, foretold by the other tests at that shift. unmoved: the most within a sample of none.
    campaign, test: the one that is asked of; '' for all of them. chance: that among all shifts of a test one stands out
    so far by itself; 0 of all tests, which speak for it together. all_s: by which all are moved, where one is off
    beyond that. part: the tests in which the clock is off, where it is right in others; None: in `test`, or in all."""

    source: str
    shift_s: float
    share: float
    unmoved: float
    campaign: str = ""
    test: str = ""
    chance: float = 0.0
    all_s: float = 0.0
    part: ShiftedPart | None = None

    @property
    def key(self) -> Key:
        """Campaign and test."""
        return self.campaign, self.test

    def moves(self) -> list[ClockMoved]:
        """What puts it right."""
        tests = [self.key] if self.part is None else self.part.off
        return [ClockMoved(source=self.source, campaign=c, test=t, moved_s=self.shift_s) for c, t in tests]

    @property
    def tells(self) -> bool:
        """Whether anything at all acts at once."""
        return self.share >= LEAST_SHARE


@dataclass(frozen=True, slots=True)
class Timings:
    """in_all: of each source. in_one: of each source in each test, as its commands act in the others."""

    in_all: tuple[Timing, ...]
    in_one: tuple[Timing, ...]
    step_s: float

    def off(self, order: Sequence[Key] = (), declared: Mapping[Key, Collection[str]] | None = None) -> list[Timing]:
        """Clocks that are off. order: of all tests, locked ones too; those that are asked, where nothing is said.
        declared: test -> sources whose clock somebody declared in it, which says nothing of the others.

        In a part of the tests where others tell that they are right; of single tests only where they are fewer than
        half: else nobody can say which are right.
        """
        found: list[Timing] = []
        for of_all in self.in_all:
            told = [t for t in self.in_one if t.source == of_all.source]
            fixed = {key for key, sources in (declared or {}).items() if of_all.source in sources}
            asked = [t for t in told if t.key not in fixed]
            keys = [key for key in order or [t.key for t in told] if key not in fixed]
            whole, single = clock_is_off(of_all, self.step_s), [t for t in asked if clock_is_off(t, self.step_s)]
            part = self._shifted_part(of_all.shift_s if whole else 0.0, asked, single, keys)
            if part is not None:
                by = of_all if whole else max(single, key=lambda t: t.share)
                found.append(replace(by, campaign="", test="", part=part))
                single = [t for t in single if whole and t.key in part.off]
            elif whole:
                found.append(of_all)
            found += single if 2 * len(single) < len(told) else []
        return found

    def _shifted_part(
        self, all_s: float, asked: list[Timing], single: list[Timing], order: Sequence[Key]
    ) -> ShiftedPart | None:
        """The tests in which a clock is off, where some tell that it is not; None where that is no part of them. all_s:
        by which all are moved, and single ones are off beyond it."""
        near_s = GIVE_OR_TAKE * self.step_s
        tell = [t for t in asked if t.tells]
        if all_s:
            right = {t.key for t in single if abs(t.shift_s + all_s) <= near_s}
            off = {t.key for t in tell} - right
        else:
            right = {t.key for t in tell if abs(t.shift_s) <= near_s}
            shifts_s = [t.shift_s for t in single]
            off = {t.key for t in single} if len(single) > 1 and max(shifts_s) - min(shifts_s) <= near_s else set()
        if not off or not right:
            return None
        part = part_of(order, off, right)
        return part if part.plain else None

    @property
    def told(self) -> frozenset[str]:
        """Sources whose clock is known by what they command."""
        return frozenset(t.source for t in self.in_all if t.tells)

    @property
    def told_in_one(self) -> dict[tuple[str, str], frozenset[str]]:
        """The same by what they command in a test."""
        tests = dict.fromkeys((t.campaign, t.test) for t in self.in_one)
        return {
            key: frozenset(t.source for t in self.in_one if (t.campaign, t.test) == key and t.tells) for key in tests
        }


def clock_is_off(timing: Timing, step_s: float) -> bool:
    """step_s: between two samples, nearer than two of which nothing is known."""
    late = abs(timing.shift_s) >= max(LEAST_S, (GIVE_OR_TAKE + 0.5) * step_s)
    from_hour_s = abs(timing.shift_s - 3600.0 * round(timing.shift_s / 3600.0))
    if abs(timing.shift_s) > MOST_S:
        late &= from_hour_s <= ABOUT_S
    return late and timing.chance <= CHANCE and timing.tells and timing.share >= BEATS * timing.unmoved


def what_to_declare(source: str, moved_s: float, tests: str) -> str:
    """In the campaign file, to make a move for good, and to have it never made again. tests: where, 'the test'; '' for
    all of them."""
    where, was_off, was_right = f"at {tests}", f"clocks: {{{source}: {moved_s:.0f} s}}", f"clocks: {{{source}: 0 s}}"
    if not tests:
        where, was_off, was_right = (
            f"at source '{source}'",
            f"clock: {{offset: {moved_s:.0f} s}}",
            "clock: {offset: 0 s}",
        )
    return f"If it was off, declare {where} {was_off}; if it was right, {was_right}, and it is not asked again"


ENDS_AGREE = (
    ". The logs begin and end together in this test, though, as in others: then the clock was right, and the samples "
    "came late within their log (a buffer, say). That line moves them all the same, and ingest then says that the ends "
    "no longer agree"
)


def as_artefact(timing: Timing, problem: Problem, ends_agree: bool = False) -> Artefact:
    """Of a part of the tests the first one is named as its place. ends_agree: in its test the log begins and ends with
    that of the response, as ever."""
    minutes, known_to = timing.shift_s / 60, GIVE_OR_TAKE * problem.step_s / 60
    first = timing.key if timing.part is None else timing.part.off[0]
    of = "in this test, by how they act in the others" if timing.test else "in tests left out"
    tests = "" if not first[1] else "the test" if timing.part is None else "these tests"
    return Artefact(
        kind="clock_offset",
        campaign=first[0] or problem.blocks[0].test.campaign,
        test=first[1],
        at_s=None,
        size_um=None,
        why=f"with the clock of source '{timing.source}' moved by {minutes:+.0f} min (give or take {known_to:.0f})"
        f"{in_words(timing.part)} its commands foretell {in_percent(timing.share)} of the squared jumps of the "
        f"displacement "
        f"{of}, unmoved {in_percent(max(timing.unmoved, 0.0))}. The choice is made with it moved; check the time "
        f"zone and the clocks. {what_to_declare(timing.source, timing.all_s + timing.shift_s, tests)}"
        f"{ENDS_AGREE if ends_agree and timing.test else ''}",
    )
