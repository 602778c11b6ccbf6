"""Three tools and one gain, through the commands: the gain by tool is offered, added, confirmed and told."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermodata.cli import main

from ..commands import Said
from .conftest import CAMPAIGN, MODEL, lag

GROWTH = {"D25": 3.0, "D63": 1.8, "D100": 0.9}  # um/K of the bearing, by tool
TOOLS = ["D25", "D63", "D100", "D25", "D63", "D100", "D63"]
ID = "gain_by:spindle_bearing,conditions.tool.id"
NEAR = 0.1  # of the gains: noise, and a time constant that is fitted too


def write(folder: Path) -> Path:
    """Seven tests of 5 h at 60 s; the last one is locked."""
    (folder / "raw").mkdir(parents=True)
    lines = [CAMPAIGN.strip()]
    for i, tool in enumerate(TOOLS):
        rng = np.random.default_rng(i)
        t_s = np.arange(300) * 60.0
        speed = 3000.0 * rng.integers(0, 4, 10).repeat(30) * (t_s > 1200)
        feed = 10.0 * rng.integers(0, 2, 10).repeat(30) * (t_s > 1200)
        bearing, nut = 15 * lag(speed / 9000, 1500.0), 6 * lag(feed / 10, 2400.0)
        hall = 21 + 0.4 * np.sin(t_s / 9000 + i)
        z = GROWTH[tool] * lag(bearing, 1800.0) + rng.normal(0, 0.2, len(t_s))
        rows = np.column_stack([t_s, z, 21 + bearing, 21 + nut, hall, speed, feed])
        head = "time [s],dZ [um],T_bearing [degC],T_nut_Z [degC],T_hall [degC],spindle_speed [rpm],feed_Z [m/min]"
        np.savetxt(folder / "raw" / f"t{i}.csv", rows, fmt="%.4f", delimiter=",", header=head, comments="")
        role = "locked" if i == len(TOOLS) - 1 else "calibration"
        lines.append(f"  - {{id: t{i}, kind: cutting, role: {role}, tool: {{id: {tool}, diameter: {tool[1:]} mm}}}}")
    (folder / "campaign.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "baseline.yaml").write_text(MODEL, encoding="utf-8")
    return folder / "campaign.yaml"


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("tools") / "lab"
    path, store = write(folder), folder / "thermodata.store"
    assert main(["--store", str(store), "ingest", str(path), "--json"]) == 0
    assert main(["--store", str(store), "fit", str(folder / "baseline.yaml"), "--json"]) == 0
    return store


def pooled(scores: list[dict[str, Any]]) -> float:
    """Error of the calibration tests, each alike."""
    own = [s["rmse_um"] for s in scores if s["role"] == "calibration" and s["phase"] == "all"]
    assert len(own) == 6
    return float(np.sqrt(np.mean(np.square(own))))


def test_a_gain_by_tool_from_raw_files_to_the_next_version(store: Path, say: Callable[..., Said]) -> None:
    def data(*words: object) -> Any:
        said = say("--store", store, *words, "--json")
        assert said.code == 0, said.err
        return json.loads(said.out)

    found = data("diagnose", "baseline")
    head = found["candidates"][0]
    assert found["verdict"] == "refine"
    assert (head["id"], head["gain_by"], head["refinement"], head["claimed"]) == (
        ID,
        "conditions.tool.id",
        True,
        False,
    )
    assert "conditions.tool.diameter part the tests alike" in head["why"]
    told = say("--store", store, "diagnose", "baseline").out
    assert "can be refined by spindle_bearing (T_bearing) with a gain for each conditions.tool.id" in told

    held = data("confirm", "baseline", ID)
    assert held["holds"]
    assert held["locked_rmse_um_after"] < 0.5 * held["locked_rmse_um_before"]
    assert {f"spindle_bearing.gain[{tool}]" for tool in GROWTH} <= set(held["parameters"])

    added = data("add", "baseline", "1")
    assert pooled(added["scores"]) < 0.3 * pooled(added["before"])
    for tool, growth in GROWTH.items():
        assert added["parameters"][f"spindle_bearing.gain[{tool}]"]["value"] == pytest.approx(growth, rel=NEAR)

    first, second = data("history", added["model"])
    assert (first["added"], second["added"]) == (None, "spindle_bearing by conditions.tool.id")
    assert second["rmse_um"] < 0.3 * first["rmse_um"]

    again = data("diagnose", added["model"])
    assert again["verdict"] == "none"
    assert not [c for c in again["candidates"] if c["id"].startswith("gain_by:")]
    refused = say("--store", store, "add", added["model"], ID)
    assert refused.code == 2
    assert "a gain for each of them already" in refused.err


@pytest.mark.parametrize(
    ("candidate", "said"),
    [
        ("gain_by:spindle_bering,conditions.tool.id", "spindle_bearing"),
        ("gain_by:spindle_bearing", "conditions.NAME"),
        ("gain_by:spindle_bearing,conditions.tool.di", "tool.id"),
    ],
    ids=["no such effect", "no condition", "no such condition"],
)
def test_what_is_not_there_is_answered_with_what_is(
    candidate: str, said: str, store: Path, say: Callable[..., Said]
) -> None:
    for words in (("add", "baseline", candidate), ("confirm", "baseline", candidate)):
        refused = say("--store", store, *words)
        assert refused.code == 2
        assert said in refused.err
