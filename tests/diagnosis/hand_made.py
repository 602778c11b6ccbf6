"""Evidence made by hand: a candidate that passes every rule with room, moved by a test to either side of one limit.

Limits stand in the tests as numbers, never as the constants of the code: a changed constant must fail a test.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from thermodata.diagnosis.candidates import CandidateEffect
from thermodata.diagnosis.judge import Measure
from thermodata.diagnosis.problem import Block, Problem
from thermodata.diagnosis.scored import Scored
from thermodata.plugin import Drivers, Float1D, Float2D, Gain, Need, Param
from thermodata.view.dataset import ChannelInfo, TestData

ROWS = 1000  # of all tests: a sum of squared errors of 1000 is an error of 1
STEP_S = 60.0


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

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return np.column_stack([drivers.values["u"]] * len(self.gains))


def candidate(
    name: str = "plain",
    *,
    family: str = "feed_x",
    channels: Sequence[str] = ("T_a",),
    placeless: bool = False,
    refines: tuple[str, ...] = (),
) -> CandidateEffect:
    binding = {f"u{i or ''}": channel for i, channel in enumerate(channels)}
    return CandidateEffect(PlainEffect(name, family, refines=refines), binding, family, placeless)


def scored(
    name: str = "plain",
    *,
    family: str = "feed_x",
    channels: Sequence[str] = ("T_a",),
    placeless: bool = False,
    refines: tuple[str, ...] = (),
    p_value: float = 0.005,
    drop: float = 0.8,
    white_drop: float = 0.2,
    before: float | Sequence[float] = 1.0,
    after: float | Sequence[float] = 0.4,
    shape: Sequence[float] = (1.0, 0.0),
    size: float = 1.0,
    order: float = 0.0,
) -> Scored:
    """before, after: the error (RMS) of ten equal tests with ROWS rows in all, or the squared error of each test."""
    return Scored(
        candidate(name, family=family, channels=channels, placeless=placeless, refines=refines),
        {},
        np.ones(1),
        drop,
        white_drop,
        p_value,
        _squared(before),
        _squared(after),
        np.asarray(shape, dtype=np.float64),
        size,
        order,
    )


def _squared(error: float | Sequence[float]) -> Float1D:
    if isinstance(error, float | int):
        return np.full(10, error**2 * ROWS / 10)
    return np.asarray(error, dtype=np.float64)


def measure(
    *, floor: float = 0.2, spread: float | None = None, noise: float = 0.0, families: Sequence[str] = ()
) -> Measure:
    """floor: of the error, by a spread ten times as large."""
    return Measure(ROWS, 10 * floor if spread is None else spread, noise, frozenset(families))


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
        np.ones(n),
        n,
    )


def problem(*tests: Parts, noise: float = 0.0, step_s: float = STEP_S) -> Problem:
    blocks = tuple(block(parts, f"t{i}", step_s) for i, parts in enumerate(tests))
    return Problem("dZ", "um", step_s, blocks, noise)


def of_tests(count: int) -> Problem:
    """A problem whose tests are only counted."""
    return problem(*(Parts(np.zeros(4)) for _ in range(count)))
