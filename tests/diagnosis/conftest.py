"""A small machine whose truth is known: two heats, ambient air, and what a test asks for besides."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from thermodata.effect.lag import lag
from thermodata.schema.files.model import EffectSpec, Model, Response
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

STEP_S = 120.0
N = 360
CHANNELS = {
    "dZ": ChannelInfo("dZ", "displacement", "um", at="tcp", axis="Z"),
    "spindle_speed": ChannelInfo("spindle_speed", "rotational_speed", "rpm", at="spindle"),
    "T_bearing": ChannelInfo("T_bearing", "temperature", "degC", at="spindle.bearing.front"),
    "T_nut_X": ChannelInfo("T_nut_X", "temperature", "degC", at="axis.x.nut"),
    "T_hall": ChannelInfo("T_hall", "temperature", "degC", at="hall.top"),
    "T_tank": ChannelInfo("T_tank", "temperature", "degC", at="hydraulics"),
}


def make_test(
    name: str, role: str, seed: int, add: Callable[[dict[str, Any], np.ndarray], np.ndarray] | None
) -> TestData:
    rng = np.random.default_rng(seed)
    t = np.arange(N) * STEP_S
    speed = np.repeat(rng.choice([0, 3000, 6000, 9000], 6), N // 6).astype(float)
    feed = np.repeat(rng.choice([0.0, 1.0], 9), N // 9)
    channels: dict[str, Any] = {
        "spindle_speed": speed,
        "T_bearing": 22 + lag(speed / 9000 * 15, 900, STEP_S) + rng.normal(0, 0.02, N),
        "T_nut_X": 22 + lag(feed * 8, 2400, STEP_S) + rng.normal(0, 0.02, N),
        "T_hall": 21 + 2 * np.sin(2 * np.pi * (t / 86400 + rng.uniform())) + rng.normal(0, 0.02, N),
        "T_tank": 30 + lag(4 * (rng.uniform(size=9) > 0.5).repeat(N // 9), 3600, STEP_S) + rng.normal(0, 0.02, N),
    }
    y = lag(-3 * (channels["T_bearing"] - channels["T_bearing"][0]), 3000, STEP_S) + rng.normal(0, 0.1, N)
    if add is not None:
        y = y + add(channels, t)
    channels["dZ"] = y
    return TestData(
        "c",
        name,
        "mixed",
        role,
        t,
        channels,
        {k: np.ones(N, bool) for k in channels},
        np.ones(N, bool),
        channels=CHANNELS,
    )


def make_data(
    add: Callable[[dict[str, Any], np.ndarray], np.ndarray] | None = None, tests: int = 7, without: tuple[str, ...] = ()
) -> Dataset:
    """The last test is locked."""
    made = [make_test(f"t{i}", "locked" if i == tests - 1 else "calibration", 10 + i, add) for i in range(tests)]
    kept = {k: v for k, v in CHANNELS.items() if k not in without}
    return Dataset(STEP_S, tuple(made), kept)


@pytest.fixture
def spec() -> Model:
    return base()


def base() -> Model:
    """The model of a spindle alone."""
    return Model(
        schema="thermodata/model/1",
        name="base",
        campaign="c",
        response=Response(axis="Z", at="tcp"),
        step="120 s",
        effects=[EffectSpec(effect="spindle_bearing", drivers={"temperature": "T_bearing"})],
    )
