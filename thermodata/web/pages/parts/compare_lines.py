"""What a comparison says of each test and of each role: errors of the models, and differences to the pinned one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from thermodata.modelling.compare.difference import Difference
from thermodata.modelling.compare.differences import Course, between, over_tests
from thermodata.plugin import Float1D
from thermodata.report.words.numbers import base_role, pooled
from thermodata.schema.answers.result import Score

_SAME = 0.005  # of the pinned error: less is no difference


@dataclass(frozen=True, slots=True)
class Line:
    """A test and response: one error for each model, None where it was not predicted."""

    campaign: str
    test: str
    role: str
    response: str
    phase: str
    errors: tuple[float | None, ...]
    differences: tuple[Difference | None, ...] = ()  # of each but the pinned one to it
    in_sample: tuple[bool, ...] = ()  # in which models the test was fitted though it is no calibration test

    @property
    def differs(self) -> bool:
        known = [e for e in self.errors if e is not None]
        return len(known) > 1 and max(known) - min(known) > _SAME * max(known)


def lines_of(scores: list[list[Score]]) -> list[Line]:
    """A line for each test and response that any of the models was scored on. scores: of each model."""
    keys = {
        (s.campaign, s.test, s.response, s.phase): base_role(s.role)
        for each in scores
        for s in each
        if s.phase == "all"
    }
    known = [{(s.campaign, s.test, s.response, s.phase): s for s in each} for each in scores]
    found = {key: [each.get(key) for each in known] for key in keys}
    return [
        Line(
            *key[:2],
            role,
            *key[2:],
            tuple(s.rmse_um if s else None for s in found[key]),
            in_sample=tuple(s is not None and _in_sample(s) for s in found[key]),
        )
        for key, role in keys.items()
    ]


def largest(lines: Sequence[Line], units: Mapping[str, str]) -> dict[str | None, float]:
    """unit -> the largest error in it, which is the scale of its bars."""
    found: dict[str | None, float] = {}
    for line in lines:
        unit = units.get(line.response)
        found[unit] = max([found.get(unit, 0.0), *(e for e in line.errors if e is not None)])
    return {unit: most or 1.0 for unit, most in found.items()}


def _in_sample(score: Score) -> bool:
    return score.role != base_role(score.role)


def with_differences(lines: list[Line], courses: Sequence[Mapping[Course, Float1D]]) -> list[Line]:
    """The same lines, told apart by the residuals. courses: residuals of each model, the pinned one first."""
    found = [between(courses[0], other) for other in courses[1:]]
    return [
        replace(line, differences=tuple(f.get((line.campaign, line.test, line.response)) for f in found))
        for line in lines
    ]


def over_roles(
    lines: list[Line], courses: Sequence[Mapping[Course, Float1D]]
) -> list[tuple[str, list[Difference | None]]]:
    """(role, the difference of each but the pinned one to it over the role's tests)."""
    tests: dict[str, dict[tuple[str, str], None]] = {}
    for line in lines:
        tests.setdefault(line.role, {})[line.campaign, line.test] = None
    return [
        (role, [over_tests(courses[0], other, list(keys)) for other in courses[1:]]) for role, keys in tests.items()
    ]


def of_responses(courses: Mapping[Course, Float1D], responses: Sequence[str]) -> dict[Course, Float1D]:
    """The courses of these responses."""
    return {key: course for key, course in courses.items() if key[2] in responses}


def roles(scores: list[list[Score]], responses: Sequence[str]) -> list[tuple[str, list[tuple[float | None, bool]]]]:
    """(role, of each model its error, and whether tests of the role were fitted though they are no calibration)."""
    names = dict.fromkeys(base_role(s.role) for each in scores for s in each)
    return [
        (
            role,
            [
                (pooled(each, role, responses=responses), any(_in_sample(s) for s in each if base_role(s.role) == role))
                for each in scores
            ],
        )
        for role in names
    ]


def unseen(lines: Sequence[Line]) -> dict[str, set[int]]:
    """role -> the places of models that were fitted to other tests of it than the pinned one."""
    found: dict[str, set[int]] = {}
    for line in lines:
        places = {i for i, fitted in enumerate(line.in_sample) if fitted != line.in_sample[0]}
        if places:
            found.setdefault(line.role, set()).update(places)
    return found
