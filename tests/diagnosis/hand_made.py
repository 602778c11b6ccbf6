"""Evidence made by hand: a candidate that passes every rule with room, moved by a test to either side of one limit.

Limits stand in the tests as numbers, never as the constants of the code: a changed constant must fail a test.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.kin import Kin
from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.question.problem import Block, Problem
from thermodata.diagnosis.weigh.evidence import Columns, Weighed
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.plugin import Drivers, Float1D, Float2D, Gain, Need, Param
from thermodata.view.grid.dataset import ChannelInfo, TestData

ROWS = 1000  # of all tests: a sum of squared errors of 1000 is an error of 1
TESTS = 10
STEP_S = 60.0
NO_CHANCE = tuple(range(-199, 0))  # what chance makes of evidence: all of it against a candidate


@dataclass(frozen=True)
class PlainEffect:
    """The driver itself times a gain; params are given to be searched, and change nothing."""

    name: str = "plain"
    family: str = "feed_x"
    meaning: str = "made by hand"
    source: str = "this test"
    needs: tuple[Need, ...] = (Need("u", "temperature"),)
    params: tuple[Param, ...] = ()
    gains: tuple[Gain, ...] = (Gain("gain", "um/K", (0.1, 10.0), "any", ""),)
    refines: tuple[str, ...] = ()
    told_by: str | None = None

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return np.column_stack([drivers.values["u"]] * len(self.gains))


def candidate(
    name: str = "plain",
    *,
    family: str = "feed_x",
    channels: Sequence[str] = ("T_a",),
    placeless: bool = False,
    passive: bool = False,
    refines: tuple[str, ...] = (),
    kin: Kin = None,
    around: bool = False,
    of_motion: bool = False,
    of_holder: bool = False,
    of_source: bool = False,
) -> CandidateEffect:
    binding = {f"u{i or ''}": channel for i, channel in enumerate(channels)}
    effect = PlainEffect(name, family, refines=refines)
    made = CandidateEffect(effect, binding, family, placeless, passive, kin=kin, around=around, of_motion=of_motion)
    return replace(made, of_holder=of_holder, of_source=of_source)


def columns_of(candidate: CandidateEffect, contribution: Sequence[Float1D]) -> Columns:
    """One gain, one point: what the candidate does, a test each."""
    whole = np.concatenate([np.asarray(c, dtype=np.float64) for c in contribution])[:, None, None]
    return Columns(candidate, [{}], whole, np.ones((1, 1)), np.ones(1), np.zeros((1, 1)))


def scored(
    name: str = "plain",
    *,
    family: str = "feed_x",
    channels: Sequence[str] = ("T_a",),
    placeless: bool = False,
    passive: bool = False,
    refines: tuple[str, ...] = (),
    kin: Kin = None,
    around: bool = False,
    of_motion: bool = False,
    of_holder: bool = False,
    of_source: bool = False,
    evidence: float = 390.0,
    gained: float | Sequence[float] = 50.0,
    before: float | Sequence[float] = 1.0,
    after: float | Sequence[float] = 0.4,
    size: float | Sequence[float] = 1.0,
    spread: float = 0.1,
    shape: Sequence[float] = (1.0, 0.0),
    contribution: Sequence[Float1D] = (),
    coefficient: float = 1.0,
    beaten: bool = False,
) -> Scored:
    """Ten equal tests with ROWS rows in all. before, after: the error (RMS) of all tests, or of each. contribution: at
    a coefficient of 1."""
    asked = candidate(
        name,
        family=family,
        channels=channels,
        placeless=placeless,
        passive=passive,
        refines=refines,
        kin=kin,
        around=around,
        of_motion=of_motion,
        of_holder=of_holder,
        of_source=of_source,
    )
    rows = np.full(TESTS, ROWS / TESTS)
    return Scored(
        asked,
        columns_of(asked, contribution or [np.ones(4)]),
        Weighed(np.array([[evidence]]), np.array([[[coefficient]]])),
        evidence,
        _of_each(gained),
        rows,
        *[_of_each(before) ** 2 * rows, _of_each(after) ** 2 * rows] * 2,
        _of_each(size),
        spread,
        np.asarray(shape, dtype=np.float64),
        beaten=beaten,
    )


def _of_each(value: float | Sequence[float]) -> Float1D:
    return np.broadcast_to(np.asarray(value, dtype=np.float64), TESTS).copy()


def measure(
    *, floor: float = 0.2, spread: float | None = None, noise: float = 0.0, chance: Sequence[float] = NO_CHANCE
) -> Measure:
    """floor: of the error, by a spread ten times as large."""
    return Measure(10 * floor if spread is None else spread, noise, np.asarray(chance, dtype=np.float64))


def a_test(
    name: str = "t0",
    n: int = 100,
    *,
    values: Mapping[str, Float1D] | None = None,
    channels: Mapping[str, ChannelInfo] | None = None,
    step_s: float = STEP_S,
    start_unix_s: float | None = None,
    role: str = "calibration",
) -> TestData:
    values = dict(values or {})
    return TestData(
        "c",
        name,
        "mixed",
        role,
        np.arange(n) * step_s,
        values,
        {k: np.ones(n, bool) for k in values},
        np.ones(n, bool),
        start_unix_s=start_unix_s,
        channels=channels or {},
    )


@dataclass(frozen=True)
class Parts:
    """What a block is made of; response defaults to the residual, base and slack to nothing."""

    residual: Float1D
    response: Float1D | None = None
    base: Float2D | None = None
    slack: Float2D | None = None
    values: Mapping[str, Float1D] = field(default_factory=dict)
    channels: Mapping[str, ChannelInfo] = field(default_factory=dict)
    start_unix_s: float | None = None


def block(parts: Parts, name: str = "t0", step_s: float = STEP_S) -> Block:
    n = len(parts.residual)
    none = np.zeros((n, 0))
    return Block(
        a_test(
            name,
            n,
            values=parts.values,
            channels=parts.channels,
            step_s=step_s,
            start_unix_s=parts.start_unix_s,
        ),
        np.arange(n) * step_s,
        parts.residual if parts.response is None else parts.response,
        parts.residual,
        none if parts.base is None else parts.base,
        none if parts.slack is None else parts.slack,
        np.zeros(n, np.int64),
        np.arange(n),
        n,
    )


def problem(*tests: Parts, noise: float = 0.0, step_s: float = STEP_S) -> Problem:
    blocks = tuple(block(parts, f"t{i}", step_s) for i, parts in enumerate(tests))
    return Problem("dZ", "um", step_s, blocks, noise)


def of_one_model(factors: Sequence[float]) -> Problem:
    """Tests that follow one column of the model, each by its own factor."""
    rng = np.random.default_rng(1)

    def one(factor: float) -> Parts:
        base = rng.normal(size=(200, 1))
        y: Float1D = factor * base[:, 0] + 0.01 * rng.normal(size=200)
        return Parts(y, response=y, base=base)

    return problem(*map(one, factors), noise=0.01)


def of_tests(count: int) -> Problem:
    """A problem whose tests are only counted."""
    return problem(*(Parts(np.zeros(4)) for _ in range(count)))
