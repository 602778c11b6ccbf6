"""Each measured sample speaks once: of tests that hold samples of one recording the later one's do not count again.

Tests are evidence, and each is foretold by the others. A sample that stands in two of them would be weighed twice, and
a test that is left out would be foretold by its own samples.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.plugin import Bool1D
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.view.grid.dataset import Dataset, TestData
from thermodata.view.grid.shared_samples import shared_spans

LEAST_SAMPLES = 30  # that are equal to the last digit, and not all one value


@dataclass(frozen=True, slots=True)
class RepeatedSamples:
    """A test of which `samples`, shape (n,), stand in another one before it, too. whole: no measured one is left."""

    test: TestData
    other: TestData
    samples: Bool1D
    whole: bool


def each_once(
    data: Dataset, tests: Sequence[TestData], channel: Callable[[TestData], str]
) -> tuple[Dataset, list[TestData], list[RepeatedSamples]]:
    """(the same with samples that stand in an earlier one of the tests not valid, those of the tests that have some
    left, what was found). channel: of the response, in a test. Drivers stay: what they did is no evidence."""
    found: list[RepeatedSamples] = []
    for number, one in enumerate(tests):
        found += [a for other in tests[:number] if (a := repeated_in(one, other, channel, data.step_s)) is not None]
    changed = {t.key: _without_samples(t, channel(t), [a.samples for a in found if a.test is t]) for t in tests}
    gone = {key for key, test in changed.items() if test is not None and not test.sampled(channel(test)).any()}
    told = [replace(a, whole=a.test.key in gone) for a in found]
    kept = [changed[t.key] or t for t in tests if t.key not in gone or not any(a.test is t for a in found)]
    return replace(data, tests=tuple(changed.get(t.key) or t for t in data.tests)), kept, told


def repeated_in(
    one: TestData, other: TestData, channel: Callable[[TestData], str], step_s: float
) -> RepeatedSamples | None:
    """What of one test stands in the other; None where nothing does. step_s: of the grid, on which each sample is a
    mean: one that holds any of the other's is the other's."""
    mine, theirs = channel(one), channel(other)
    if mine == theirs and same_recording(one, other, mine):
        return RepeatedSamples(one, other, np.ones(len(one.t_s), bool), whole=True)
    spans = shared_spans(one, other, mine, theirs)
    samples = np.zeros(len(one.t_s), bool)
    for from_s, to_s in spans:
        samples |= (one.t_s > from_s - step_s) & (one.t_s < to_s + step_s)
    samples &= one.sampled(mine)
    return RepeatedSamples(one, other, samples, whole=False) if samples.any() else None


def same_recording(one: TestData, other: TestData, response: str) -> bool:
    """Whether two tests have the same values of a response, at all times of theirs: noise is never the same."""
    if not all(response in t.values for t in (one, other)) or len(one.t_s) != len(other.t_s):
        return False
    a, b = one.values[response], other.values[response]
    known = np.isfinite(a)
    enough = int(known.sum()) >= LEAST_SAMPLES and float(np.ptp(a[known])) > 0
    return enough and np.array_equal(one.t_s, other.t_s) and np.array_equal(a, b, equal_nan=True)


def as_artefacts(found: Sequence[RepeatedSamples]) -> list[Artefact]:
    """What was left out, as the answer says it."""
    return [
        Artefact(kind="copy", campaign=a.test.campaign, test=a.test.test, at_s=None, size_um=None, why=_why_left_out(a))
        for a in found
    ]


def _why_left_out(found: RepeatedSamples) -> str:
    one, other = found.test, found.other
    name = other.test if other.campaign == one.campaign else "/".join(other.key)
    times = one.t_s[found.samples]
    what = "all of it is" if found.whole else f"{times[0] / 3600:.3g} to {times[-1] / 3600:.3g} h of it are"
    left = "it was left out" if found.whole else "these samples were left out here"
    return (
        f"{what} the recording of '{name}', another test that takes part: what was measured once is no evidence twice, "
        f"and foretells itself. In this answer {left}; give the two windows that do not overlap, or take one of them "
        "out of the campaign file"
    )


def _without_samples(test: TestData, channel: str, samples: Sequence[Bool1D]) -> TestData | None:
    """None where nothing of it stands in another."""
    if not samples:
        return None
    left = test.sampled(channel) & ~np.logical_or.reduce(samples)
    return replace(test, valid={**test.valid, channel: left})
