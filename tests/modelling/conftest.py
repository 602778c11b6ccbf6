"""A small machine whose truth is known: five effects, eight tests of twelve hours at 60 s."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest
import yaml

from thermodata.effect.lag import lag
from thermodata.modelling import run
from thermodata.plugin import Float1D
from thermodata.schema.files.model import Model
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

STEP = 60.0
CHANNELS = {
    c.name: c
    for c in (
        ChannelInfo("dZ", "displacement", "um", "tcp", "Z"),
        ChannelInfo("T_bearing", "temperature", "degC", "spindle.bearing.front"),
        ChannelInfo("T_nut", "temperature", "degC", "axis.z.nut", resolution=0.1),
        ChannelInfo("T_hall", "temperature", "degC", "hall"),
        ChannelInfo("speed", "rotational_speed", "rpm", "spindle"),
        ChannelInfo("coolant_on", "state", "1", "coolant.supply"),
    )
}
EFFECTS = ("spindle_bearing", "feed_screw", "ambient_frame", "centrifugal_shift", "coolant")
TRUTH = {
    "spindle_bearing.tau": 20.0,
    "spindle_bearing.gain": 1.5,
    "feed_screw.tau": 90.0,
    "feed_screw.gain": 2.0,
    "ambient_frame.tau": 240.0,
    "ambient_frame.gain": -3.0,
    "centrifugal_shift.gain": -8.0,
    "coolant.tau": 30.0,
    "coolant.gain": 6.0,
}


def make_test(k: int, role: str, hours: float = 12.0, noise: float = 0.3, name: str | None = None) -> TestData:
    """Idle for ten minutes, then everything at random."""
    rng = np.random.default_rng(k)
    n = int(hours * 3600 / STEP) + 1
    t = np.arange(n) * STEP

    def blocks(choices: list[float], length: int) -> Float1D:
        out = np.repeat(rng.choice(choices, n // length + 1), length)[:n].astype(np.float64)
        out[:10] = 0.0
        return out

    speed, feed, cool = blocks([0, 3000, 6000, 9000], 60), blocks([0, 1], 90), blocks([0, 1], 120)
    bearing, nut = 3e-3 * lag(speed, 900, STEP), 8 * lag(feed, 2400, STEP)
    phase = rng.uniform()
    hall = 2 * (np.sin(2 * np.pi * (t / 86400 + phase)) - np.sin(2 * np.pi * phase))
    y = (
        1.5 * lag(bearing, 1200, STEP)
        + 2.0 * lag(nut, 5400, STEP)
        - 3.0 * lag(hall, 14400, STEP)
        - 8.0 * (speed / 1e4) ** 2
        + 6.0 * lag(cool, 1800, STEP)
        + rng.normal(0, noise, n)
        + rng.normal(0, 20)
    )
    values = {
        "dZ": y,
        "T_bearing": 22 + bearing + rng.normal(0, 0.02, n),
        "T_nut": 21 + nut + rng.normal(0, 0.02, n),
        "T_hall": 20 + hall + rng.normal(0, 0.02, n),
        "speed": speed,
        "coolant_on": cool,
    }
    return TestData(
        "c",
        name or f"t{k}",
        "spectrum",
        role,
        t,
        values,
        {q: np.ones(n, bool) for q in values},
        np.ones(n, bool),
        {"spindle": "SP1"},
        machine="m1",
        channels=CHANNELS,
    )


@pytest.fixture(scope="session")
def world() -> Dataset:
    roles = ["calibration"] * 5 + ["verification"] * 2 + ["locked"]
    return Dataset(STEP, tuple(make_test(k, role) for k, role in enumerate(roles)), CHANNELS, "v1")


Spec = Callable[..., Model]


@pytest.fixture(scope="session")
def spec() -> Spec:
    """spec("spindle_bearing", {"effect": ...}, calibrate_on=[...]) -> Model."""

    def make(*effects: str | Mapping[str, Any], **more: Any) -> Model:
        lines = [{"effect": e} if isinstance(e, str) else dict(e) for e in effects]
        return Model.model_validate(
            {
                "schema": "thermodata/model/1",
                "name": "base",
                "campaign": "c",
                "step": "60 s",
                "response": {"axis": "Z", "at": "tcp"},
                "effects": lines,
            }
            | more
        )

    return make


Change = Callable[..., Dataset]


@pytest.fixture(scope="session")
def changed() -> Change:
    """changed(data, "t0", dZ=values) -> the same data with some channels of one test replaced (None: absent)."""

    def make(data: Dataset, test: str, **values: Float1D | None) -> Dataset:
        def one(old: TestData) -> TestData:
            if old.test != test:
                return old
            new = {k: v for k, v in {**old.values, **values}.items() if v is not None}
            return replace(old, values=new, valid={k: np.ones(len(old.t_s), bool) for k in new})

        return replace(data, tests=tuple(one(t) for t in data.tests))

    return make


def write_store(folder: Path, world: Dataset, without: Mapping[str, str], fits: Sequence[Model]) -> None:
    """Logs in `raw`, `campaign.yaml`, and `store`, which holds them and the models."""
    (folder / "raw").mkdir()
    for test in world.tests:
        names = [n for n in CHANNELS if n != without.get(test.test)]
        lines = [";".join(["t [s]", *names])]
        table = np.column_stack([test.t_s, *(test.values[n] for n in names)])
        lines += [";".join(f"{v:.6f}" for v in row) for row in table]
        (folder / "raw" / f"{test.test}.csv").write_text("\n".join(lines) + "\n")
    units = {"displacement": "um", "temperature": "degC", "rotational_speed": "rpm", "state": "1"}
    channels = {
        c.name: {"source": "log", "signal": c.name, "quantity": c.quantity, "unit": units[c.quantity], "at": c.at}
        for c in CHANNELS.values()
    }
    channels["dZ"]["axis"] = "Z"
    campaign = {
        "schema": "thermodata/campaign/1",
        "id": "c",
        "machine": {"id": "m1", "spindle": "SP1"},
        "sources": {
            "log": {
                "reader": "table",
                "files": "raw/{test}.csv",
                "table": {"delimiter": ";", "decimal": ".", "header_rows": 1, "time": {"column": 1, "unit": "s"}},
            }
        },
        "channels": channels,
        "tests": [{"id": t.test, "kind": "spectrum", "role": t.role} for t in world.tests],
    }
    (folder / "campaign.yaml").write_text(yaml.safe_dump(campaign))
    made = Store(folder / "store", create=True)
    ingest(made, folder / "campaign.yaml")
    for model in fits:
        run.fit(made, model)


Stored = Callable[..., Store]


@pytest.fixture(scope="session")
def stored(once: Callable[[str, Callable[[Path], object]], Path]) -> Stored:
    """stored(world, folder, {"t0": "T_nut"}, fits=[spec("coolant")]) -> the store that `write_store` made in a folder
    that is empty. without: test -> channel that its log lacks. fits: models that are fitted in it. What was made of the
    same before is copied."""

    def make(
        world: Dataset, folder: Path, without: Mapping[str, str] = MappingProxyType({}), *, fits: Sequence[Model] = ()
    ) -> Store:
        what = hashlib.sha256(repr((sorted(without.items()), [m.model_dump_json() for m in fits])).encode())
        for test in world.tests:
            what.update(repr((test.test, test.role, sorted(test.values))).encode())
            for name in sorted(test.values):
                what.update(test.values[name].tobytes())
        made = once(f"stored-{what.hexdigest()[:16]}", lambda place: write_store(place, world, without, fits))
        shutil.copytree(made, folder, dirs_exist_ok=True)
        return Store(folder / "store")

    return make
