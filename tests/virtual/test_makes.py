"""The machines that others made: each writes a campaign whose signals its logs hold; its truth is of what is logged."""

from __future__ import annotations

import json
from collections import Counter
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from thermodata.effect.registry import all_effects
from thermodata.reader.contract.guard import described
from thermodata.reader.finding.match import match_signal
from thermodata.reader.finding.registry import reader
from thermodata.schema.files.load import load_campaign, load_model
from thermodata.store.raw.streams import declared

from ..benchmarks.makes.faults import come_loose, slipped
from ..benchmarks.makes.truth import Plan, channels

HERE = "tests.benchmarks.makes"
ORDINARY = {"one": 13, "two": 4, "none": 3, "not_logged": 2, "outside": 1, "fault": 1}
KINDS = {  # of a block of cases of each make
    "examiner_mill": ORDINARY | {"one": 15},
    "heavy_lathe": ORDINARY,
    "horizontal_centre": ORDINARY,
    "long_lathe": {"one": 10, "two": 2, "half": 2, "none": 3, "not_logged": 1},
    "small_mill": ORDINARY,
    "spindle_mill": ORDINARY,
    "trunnion_mill": ORDINARY | {"one": 14, "three": 1},
}
MAKES = tuple(KINDS)
WEAK = {"long_lathe": 2}  # of a block, where not 4
SMALL = {"REST": 20, "COUNT": (8, 9), "LENGTH": (20, 25)}  # steps before a test, tests, minutes of one


def shortened(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Tests of minutes after little rest, so that a case takes a second at most."""
    make, programme, machine = (import_module(f"{HERE}.{name}{part}") for part in ("", ".programme", ".machine"))
    if hasattr(make, "TESTS"):
        monkeypatch.setattr(make, "TESTS", [(kind, role, 0.7) for kind, role, _ in make.TESTS])
    else:
        monkeypatch.setattr(programme, "HOURS", dict.fromkeys(programme.HOURS, (0.2, 0.3)))
    for part in (programme, machine):
        for setting in SMALL.keys() & vars(part).keys():
            monkeypatch.setattr(part, setting, SMALL[setting])


def written(monkeypatch: pytest.MonkeyPatch, name: str, folder: Path, case: int) -> dict[str, Any]:
    shortened(monkeypatch, name)
    with threadpool_limits(1):
        truth: dict[str, Any] = import_module(f"{HERE}.{name}").write(folder, case)
    return truth


def plans(name: str, block: int) -> list[Plan]:
    """What the cases of a block hide."""
    causes, size = import_module(f"{HERE}.{name}.causes"), sum(KINDS[name].values())
    return [causes.plan(size * block + k, np.random.default_rng(k)) for k in range(size)]


@pytest.mark.parametrize("name", MAKES)
def test_a_make_writes_a_campaign_of_what_its_logs_hold_and_right_names_of_its_channels(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    truth = written(monkeypatch, name, tmp_path, 0)
    assert json.loads((tmp_path / "truth.json").read_text()) == truth
    campaign, model = load_campaign(tmp_path / "campaign.yaml"), load_model(tmp_path / "model.yaml")
    assert model.campaign == campaign.id
    logged = set(campaign.channels)
    assert set(truth.get("logged", ())) < logged
    assert {channel for effect in model.effects for channel in effect.drivers.values()} <= logged
    for log, source in campaign.sources.items():
        files = [tmp_path / source.files.format(test=test.id) for test in campaign.tests]
        assert all(file.stat().st_size > 100 for file in files)
        signals = described(reader(source.reader), files[0], declared(log, source)).signals
        for channel in campaign.channels.values():
            assert channel.source != log or match_signal(channel.signal, signals)
    assert truth["kind"] == "one"
    (hidden,) = truth["hidden"]
    assert hidden["right"]
    for said in hidden["right"]:
        effect, channels = said.split(":")
        assert effect in all_effects()
        assert set(channels.split(",")) <= logged


@pytest.mark.parametrize("block", [0, 1])
@pytest.mark.parametrize("name", MAKES)
def test_the_cases_of_a_block_have_each_kind_as_often(name: str, block: int) -> None:
    drawn = plans(name, block)
    assert Counter(plan.kind for plan in drawn) == KINDS[name]
    assert [plan.kind for plan in drawn if plan.weak] == ["one"] * WEAK.get(name, 4)
    number = {"one": 1, "half": 1, "two": 2, "three": 3, "not_logged": 1}
    assert all(len(set(plan.hidden)) == number.get(plan.kind, 0) for plan in drawn)


@pytest.mark.parametrize("name", MAKES)
def test_another_block_hides_other_causes(name: str) -> None:
    assert [plan.hidden for plan in plans(name, 0)] != [plan.hidden for plan in plans(name, 1)]


@pytest.mark.parametrize("name", MAKES)
def test_of_a_cause_that_is_not_logged_no_channel_is(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = next(k for k, plan in enumerate(plans(name, 0)) if plan.kind == "not_logged")
    truth = written(monkeypatch, name, tmp_path, case)
    (hidden,) = truth["hidden"]
    assert hidden["right"] == []
    right = import_module(f"{HERE}.{name}.causes").CAUSES[hidden["cause"]].right
    assert not channels(right) & set(load_campaign(tmp_path / "campaign.yaml").channels)


def test_on_the_spindle_mill_a_hidden_cause_moves_the_tool_along_the_axis_that_is_asked() -> None:
    causes = import_module(f"{HERE}.spindle_mill.causes").CAUSES
    for plan in (plan for block in range(3) for plan in plans("spindle_mill", block)):
        assert all(plan.axis in causes[k].mix for k in plan.hidden)


def test_what_acts_in_half_of_the_tests_of_the_long_lathe_rests_in_the_others() -> None:
    programme = import_module(f"{HERE}.long_lathe.programme")
    for hidden in (plan.hidden for block in range(7) for plan in plans("long_lathe", block) if plan.kind == "half"):
        runs = programme.campaign(np.random.default_rng(1), hidden, True)
        driven = {programme.DRIVEN_BY[k] for k in hidden}
        assert not any(r.inputs[name].any() for r in runs[1::2] for name in driven)


def test_on_the_examiner_mill_a_case_asks_for_a_tilt_and_logs_what_goes_with_its_cause_and_is_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    truth = written(monkeypatch, "examiner_mill", tmp_path, 1)
    campaign, model = load_campaign(tmp_path / "campaign.yaml"), load_model(tmp_path / "model.yaml")
    assert truth["axis"] == "T"
    assert campaign.channels[model.response.channel].derive == "(dY_high - dY_low) / 160 mm"
    decoy, place, _ = truth["lab"]["decoy"]
    assert campaign.channels[decoy].at == place
    (hidden,) = truth["hidden"]
    assert decoy not in channels(" ".join([*hidden["right"], *hidden["twins"]]))


def test_a_fault_begins_where_it_is_told() -> None:
    d, slip = slipped(np.zeros(6), 5.0, 3, 1800.0, "t1")
    assert d.tolist() == [0, 0, 0, 5, 5, 5]
    assert slip == "probe slips by 5.0 um in t1 at 1.50 h"
    x, loose = come_loose(np.full(4, 40.0), np.full(4, 20.0), 2, 1800.0, "T_brg", "t1")
    assert x.tolist() == [40, 40, 25, 25]
    assert loose == "T_brg comes loose in t1 at 1.00 h"
    x, _ = come_loose(np.full(4, 40.0), np.full(4, 20.0), 2, 1800.0, "T_brg", "t1", share=0.5)
    assert x.tolist() == [40, 40, 30, 30]


def test_every_make_is_tested() -> None:
    folder = Path(__file__).parents[1] / "benchmarks" / "makes"
    assert sorted(path.parent.name for path in folder.glob("*/__init__.py")) == list(MAKES)
