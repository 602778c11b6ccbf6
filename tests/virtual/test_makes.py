"""The machines that others made: what each writes is a campaign, and its truth speaks of what is logged."""

from __future__ import annotations

import json
from importlib import import_module
from pathlib import Path

import pytest
from threadpoolctl import threadpool_limits

from thermodata.effect.registry import all_effects
from thermodata.schema.load import load_campaign, load_model

HERE = "tests.benchmarks.makes"
MAKES = ("heavy_lathe", "horizontal_centre", "small_mill")


def shortened(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Tests of minutes after little rest, so that a case takes a second at most."""
    make, programme, machine = (import_module(f"{HERE}.{name}{part}") for part in ("", ".programme", ".machine"))
    if name == "small_mill":
        monkeypatch.setattr(programme, "HOURS", dict.fromkeys(programme.HOURS, (0.2, 0.3)))
    else:
        monkeypatch.setattr(make, "TESTS", [(kind, role, 0.7) for kind, role, _ in make.TESTS])
    if name != "heavy_lathe":
        monkeypatch.setattr(programme, "REST", 20)
        monkeypatch.setattr(machine, "REST", 20)


@pytest.mark.parametrize("name", MAKES)
def test_a_make_writes_a_campaign_and_right_names_of_its_channels(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shortened(monkeypatch, name)
    with threadpool_limits(1):
        truth = import_module(f"{HERE}.{name}").write(tmp_path, 0)
    assert json.loads((tmp_path / "truth.json").read_text()) == truth
    campaign, model = load_campaign(tmp_path / "campaign.yaml"), load_model(tmp_path / "model.yaml")
    assert model.campaign == campaign.id
    logged = set(campaign.channels)
    assert set(truth["logged"]) < logged
    assert {channel for effect in model.effects for channel in effect.drivers.values()} <= logged
    for source in campaign.sources.values():
        for test in campaign.tests:
            assert (tmp_path / source.files.format(test=test.id)).stat().st_size > 100
    assert truth["kind"] == "one"
    (hidden,) = truth["hidden"]
    assert hidden["right"]
    for said in hidden["right"]:
        effect, channels = said.split(":")
        assert effect in all_effects()
        assert set(channels.split(",")) <= logged


def test_every_make_is_tested() -> None:
    folder = Path(__file__).parents[1] / "benchmarks" / "makes"
    assert sorted(path.parent.name for path in folder.glob("*/__init__.py")) == list(MAKES)
