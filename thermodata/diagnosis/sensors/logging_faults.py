"""Faults of the logs that look like physics: a clock that is off, a probe whose gain is wrong in one test."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.clocks.moves import moved
from thermodata.diagnosis.clocks.timings import what_to_declare
from thermodata.diagnosis.question.problem import Block, Problem
from thermodata.plugin import Float2D
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.schema.units.quantity import NOT_DRIVERS
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

SHIFTS_S = (-900.0, -600.0, -450.0, -300.0, -180.0, -120.0, 120.0, 180.0, 300.0, 450.0, 600.0, 900.0)
MISFIT_TIMES = 3.0  # a fit that leaves this many times what a refit leaves has wrong parameters
CLOCK_DROP = 0.4  # fall of the squared error that makes a shift worth a name;
# of temperatures alone this: a sensor that lags, or the slow share of a distributed machine, is late as a clock is
WARM_CLOCK_DROP = 0.75
GAIN_OFF = 0.15  # a factor further from 1 than this: the gain is wrong
ALL_DROP = 0.5  # mending a test must take away this share of the squared error of all
GAIN_DROP = (
    0.9  # a factor must take away nearly all of a test's error: a missing effect also makes a test larger or smaller
)
# [%] of the model with the fault mended: what a poor model says of a log is worse than silence
LEAST_FIT = 60.0
LEAST_TESTS = 4  # of fewer nobody can say which one is wrong
NOISES = 5.0  # a test with a smaller error than this many times the noise has no wrong gain


def clocks_beside(channels: Mapping[str, ChannelInfo], drivers: Iterable[str], response: str) -> dict[str, str]:
    """Driver -> source, of the drivers that were logged by another source than the response."""
    home = channels[response].source
    return {n: s for n in drivers if n in channels and (s := channels[n].source) and s != home}


def clock_offsets(
    problem: Problem,
    base: Callable[[TestData], Float2D],
    otherwise: Callable[[TestData], Float2D],
    sources: Mapping[str, str],
    warm: Collection[str],
) -> list[Artefact]:
    """Sources whose drivers would explain more if their clock were moved, the same in all tests.

    base(test): the model's columns, shape (n, k); otherwise(test): how its effects may act otherwise, likewise.
    sources: channel -> source, of the model's drivers. warm: those that are temperatures. The smallest error must lie
    at a shift, not at zero and not at the end of the range, where something slower is at work; and where the drivers
    are moved to come later, it must fall as much where the effects may act otherwise: heat that passes two bodies comes
    late by itself, and none comes early.
    """

    def freed(test: TestData) -> Float2D:
        return np.column_stack([base(test), otherwise(test)])

    artefacts = []
    now = _squared_error(problem, base, {})
    energy = float(sum(b.response @ b.response for b in problem.blocks))
    for source in sorted(set(sources.values())):
        names = {c for c, s in sources.items() if s == source}
        errors = {d: _squared_error(problem, base, dict.fromkeys(names, d)) for d in SHIFTS_S}
        drop = WARM_CLOCK_DROP if names <= {*warm} else CLOCK_DROP
        best = shift_that_explains(now, errors, energy, drop)
        if best is not None and (
            best < 0
            or _squared_error(problem, freed, dict.fromkeys(names, best))
            < (1 - drop) * _squared_error(problem, freed, {})
        ):
            rms = [float(np.sqrt(e / max(problem.rows, 1))) for e in (now, errors[best])]
            artefacts.append(
                Artefact(
                    kind="clock_offset",
                    campaign=problem.blocks[0].test.campaign,
                    test="",
                    at_s=None,
                    size_um=rms[0] - rms[1],
                    why=f"with the clock of source '{source}' moved by {best / 60:+.0f} min the error falls from "
                    f"{rms[0]:.2f} to {rms[1]:.2f} {problem.unit} in all tests together: check the time zone and the "
                    f"clocks. {what_to_declare(source, best, '')}",
                )
            )
    return artefacts


def shift_that_explains(now: float, errors: Mapping[float, float], energy: float, drop: float) -> float | None:
    """The shift [s] with the smallest squared error, where that says that the clock is off.

    now: the squared error unmoved. drop: the share of it that a clock takes away at least. energy: the squared
    response, by which a model is judged that explains nothing.
    """
    best = min(errors, key=lambda d: errors[d])
    inside = abs(best) < max(SHIFTS_S)
    return (
        best if inside and errors[best] < (1 - drop) * now and fit_percent(errors[best], energy) >= LEAST_FIT else None
    )


def _squared_error(problem: Problem, base: Callable[[TestData], Float2D], shift_s: Mapping[str, float]) -> float:
    columns, responses = [], []
    for block in problem.blocks:
        columns.append(block.compress(base(moved(block.test, shift_s)) if shift_s else base(block.test)))
        responses.append(block.response)
    gram = sum(c.T @ c for c in columns)
    cross = sum(c.T @ y for c, y in zip(columns, responses, strict=True))
    theta = np.linalg.lstsq(np.atleast_2d(gram), np.atleast_1d(cross), rcond=1e-9)[0]
    return float(sum(np.sum((y - c @ theta) ** 2) for c, y in zip(columns, responses, strict=True)))


def wrong_gains(problem: Problem) -> list[Artefact]:
    """Tests whose response goes by another factor than what the model and the other tests say.

    Asked by mending one test at a time and refitting all: a joint fit to a wrong test is wrong for every test. For
    the same reason what explains most is mended before anything else is asked, and a sound test is not blamed for it.
    """
    blocks = problem.blocks
    if len({b.test.key for b in blocks}) < LEAST_TESTS:
        return []
    tests = _Tests(blocks)
    found: dict[int, Artefact] = {}
    while (worst := _worst_factor(tests, problem, set(found))) is not None:
        i, factor, squared = worst
        found[i] = _wrong_gain(blocks[i], factor, squared)
        tests.mend(i, factor)
    return [found[i] for i in sorted(found)]


class _Tests:
    """The model's columns and the response of each test, from which factors are taken away."""

    def __init__(self, blocks: Sequence[Block]) -> None:
        self.gram = np.stack([b.base.T @ b.base for b in blocks])
        self.cross = np.stack([b.base.T @ b.response for b in blocks])
        self.energy = np.array([float(b.response @ b.response) for b in blocks])
        self.rows = np.array([len(b.response) for b in blocks])

    def mend(self, i: int, factor: float) -> None:
        self.cross[i] /= factor
        self.energy[i] /= factor**2

    def error(self, i: int = 0, factor: float = 1.0) -> tuple[float, float]:
        """(squared error of all tests refitted, their FIT in per cent), test i divided by a factor."""
        scale = np.where(np.arange(len(self.energy)) == i, 1 / factor, 1.0)
        cross, energy = (scale[:, None] * self.cross).sum(axis=0), float(scale**2 @ self.energy)
        left = energy - float(cross @ np.linalg.lstsq(self.gram.sum(axis=0), cross, rcond=1e-9)[0])
        return left, fit_percent(left, energy)

    def by_the_others(self, i: int) -> Foretold:
        """What a model of the others says of test i."""
        others = np.arange(len(self.energy)) != i
        theta = np.linalg.lstsq(self.gram[others].sum(axis=0), self.cross[others].sum(axis=0), rcond=1e-9)[0]
        return Foretold(float(self.energy[i]), float(theta @ self.cross[i]), float(theta @ self.gram[i] @ theta))


@dataclass(frozen=True, slots=True)
class Foretold:
    """A test and what a model of the others says of it: sums of squares and products. energy: of the response. along:
    of both. power: of what is said."""

    energy: float
    along: float
    power: float

    @property
    def factor(self) -> float:
        """How many times what is said the response is; 1 where nothing is said."""
        return self.along / self.power if self.power > 0 else 1.0

    def error(self, factor: float = 1.0) -> float:
        """Squared error where the response is so many times what is said."""
        return self.energy - 2 * factor * self.along + factor**2 * self.power


def fit_percent(left: float, energy: float) -> float:
    """FIT by squared errors: (1 - error / spread) x 100."""
    return (1 - float(np.sqrt(max(left, 0.0) / energy))) * 100 if energy > 0 else 0.0


def _worst_factor(tests: _Tests, problem: Problem, mended: set[int]) -> tuple[int, float, float] | None:
    """(test, its factor, its squared error) of the wrong factor that explains most, where one is wrong."""
    as_it_is, _ = tests.error()
    best, least = None, np.inf
    for i in sorted(set(range(len(problem.blocks))) - mended):
        said = tests.by_the_others(i)
        factor, before = said.factor, said.error()
        rms = float(np.sqrt(max(before, 0.0) / tests.rows[i]))
        if not gain_is_wrong(factor, before, said.error(factor), rms, problem.noise):
            continue
        left, fit = tests.error(i, factor)
        if a_fault_explains(as_it_is, left, fit) and left < least:
            best, least = (i, factor, before), left
    return best


def _wrong_gain(block: Block, factor: float, squared: float) -> Artefact:
    return Artefact(
        kind="gain",
        campaign=block.test.campaign,
        test=block.test.test,
        at_s=None,
        size_um=float(np.sqrt(squared / max(len(block.response), 1))),
        why=f"the displacement is {factor:.2f} times what the other tests predict: check the probe's gain in this "
        "test, or whether the machine was another",
    )


def a_fault_explains(as_it_is: float, mended: float, fit: float) -> bool:
    """Squared errors of all tests: as they are, and with one test mended; fit [%]: of the model then."""
    return mended < (1 - ALL_DROP) * as_it_is and fit >= LEAST_FIT


def gain_is_wrong(factor: float, before: float, after: float, rms: float, noise: float) -> bool:
    """before, after: squared error of a test without and with the factor. rms: of the test without it."""
    return factor > 0 and abs(factor - 1) > GAIN_OFF and after < (1 - GAIN_DROP) * before and rms > NOISES * noise


def faulty_sensors(data: Dataset, response: str, driven_by: Collection[str] = ()) -> list[Artefact]:
    """Channels whose sensor is judged faulty in a test: they drive no candidate there; of many tests, in none.
    driven_by: the channels that the model reads, without which a test is lost."""
    return [
        Artefact(
            kind="sensor",
            campaign=test.campaign,
            test=test.test,
            at_s=None,
            size_um=None,
            why=f"'{name}' is flagged '{info.faulty}', so it {_drives_no(name, data)}"
            f"{_said_of_lost_test(name, test) if name in driven_by else ''}: see thermodata quality, and overrule the "
            "flag in the campaign file where the reading is sound",
        )
        for test in data.tests
        for name, info in test.channels.items()
        if info.faulty is not None and name != response and info.quantity not in NOT_DRIVERS
    ]


def _said_of_lost_test(name: str, test: TestData) -> str:
    if name in test.values and np.isfinite(test.values[name]).any():
        return ""
    return ", and the model, which reads it, has lost this test"


def _drives_no(name: str, data: Dataset) -> str:
    if data.channels[name].faulty is not None:
        return "is no driver of a candidate"
    return "drives no candidate in this test, and does in those in which it is sound"


def wrong_parameters(problem: Problem, now: float, refitted: float, floor: float) -> list[Artefact]:
    """The same effects fitted to all open tests would leave much less: parameters are wrong, by how they were fitted or
    by what they had to stand for.

    now: error of the model as it is fitted. refitted: on left-out tests after a refit. floor: error that is left alone.
    """
    if now < max(MISFIT_TIMES * refitted, floor):
        return []
    why = (
        f"as it is fitted the model leaves {now:.2f} {problem.unit} about each test's mean; the same "
        f"effects refitted to all open tests leave "
        f"{refitted:.2f} on tests left out: its parameters do not hold here; check calibrate_on, fixed and bounds. "
        "Where nothing is wrong with these, a cause may be missing that moves with what the model has in the tests it "
        "was fitted to: its gains took that in, and are others where the two part"
    )
    return [
        Artefact(
            kind="parameters",
            campaign=problem.blocks[0].test.campaign,
            test="",
            at_s=None,
            size_um=now - refitted,
            why=why,
        )
    ]


def first_of_each(artefacts: Sequence[Artefact]) -> list[Artefact]:
    """A test that was cut into parts says a fault once."""
    return list({(a.kind, a.campaign, a.test, a.at_s): a for a in reversed(artefacts)}.values())[::-1]
