"""What a first model lacks is said with the lines that ask for it; and a campaign is called by a folder that says more
than 'raw'."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands import Say
from thermodata.draft.make import first_model
from thermodata.draft.writing.own_id import id_of


def _logged(folder: Path, head: str) -> Path:
    width = head.count(";")
    rows = [f"{10 * i}" + "".join(f";{20 + 0.01 * i + k:.2f}" for k in range(width)) for i in range(60)]
    (folder / "t1.csv").write_text("\n".join([f"Time [s]{head}", *rows]) + "\n", "utf-8")
    return folder


@pytest.mark.parametrize(
    ("head", "lacks", "asked", "not_asked"),
    [
        (";Z [mm];Spindle bearing front [°C]", "a displacement of the tool", "Z", "Spindle"),
        (";Probe Z [um];T17 [°C]", "a temperature or a speed with its place", "T17", "Probe"),
    ],
)
def test_init_and_first_model_say_what_is_missing_and_which_line_asks(
    tmp_path: Path, say: Say, head: str, lacks: str, asked: str, not_asked: str
) -> None:
    said = say("init", _logged(tmp_path, head))
    assert said.code == 0
    assert not (tmp_path / "model.yaml").exists()
    (line,) = [x for x in said.err.splitlines() if "no model.yaml" in x]
    assert lacks in line
    assert f"answer the '# ?' of {asked}," in line
    campaign = tmp_path / "campaign.yaml"
    steps = f"then thermodata ingest {campaign}, thermodata first-model {campaign}, thermodata fit "
    assert steps in said.err.splitlines()[-1]
    again = say("init", tmp_path)
    assert (again.code, f"thermodata first-model {campaign} drafts a model" in again.err) == (2, True)
    refused = say("first-model", tmp_path / "campaign.yaml")
    assert refused.code != 0
    assert f"answer the '# ?' of {asked}" in refused.err
    assert not_asked not in refused.err


def test_init_says_nothing_of_a_model_that_it_wrote(tmp_path: Path, say: Say) -> None:
    said = say("init", _logged(tmp_path, ";Probe Z [um];Spindle bearing front [°C]"))
    assert (tmp_path / "model.yaml").exists()
    assert "no model.yaml" not in said.err
    assert "first-model" not in said.err
    assert said.err.splitlines()[-1].endswith(f"thermodata fit {tmp_path / 'model.yaml'}")


@pytest.mark.parametrize(
    ("path", "name"),
    [
        ("B3/raw", "B3"),
        ("B3/data/raw", "B3"),
        ("B3/Messungen", "B3"),
        ("B3/raw_data", "B3"),
        ("B3/Rohdaten", "B3"),
        ("rawlings", "rawlings"),
        ("data_2026", "data_2026"),
        ("raw/B3", "B3"),
    ],
)
def test_a_campaign_is_called_by_a_folder_that_says_more_than_raw(tmp_path: Path, path: str, name: str) -> None:
    assert id_of(tmp_path / path) == name


def test_sensors_that_drive_nothing_are_counted_where_not_all_are_named(tmp_path: Path) -> None:
    places = "".join(f"  T_{i}: {{source: log, signal: T_{i}, quantity: temperature, unit: degC}}\n" for i in range(16))
    path = tmp_path / "campaign.yaml"
    path.write_text(
        "schema: thermodata/campaign/1\nid: lab\nmachine: {id: m}\n"
        'sources: {log: {reader: table, files: "raw/{test}.csv"}}\nchannels:\n'
        "  dZ: {source: log, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp}\n"
        "  T_b: {source: log, signal: T_b, quantity: temperature, unit: degC, at: spindle.bearing.front}\n"
        f"{places}tests:\n  - {{id: a, kind: mixed, role: calibration}}\n",
        encoding="utf-8",
    )
    first_model(path)
    assert "T_11 and 4 more\n" in (tmp_path / "model.yaml").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("held", "name"),
    [
        ({"lathe": "/elsewhere/campaign.yaml"}, "B3"),
        ({"B3": "/elsewhere/campaign.yaml"}, "hall-B3"),
        ({"B3": "/elsewhere/campaign.yaml", "hall-B3": "/at/campaign.yaml"}, "B3-2"),
        ({"B3": "", "hall-B3": "", "B3-2": ""}, "B3-3"),
        ({"B3": "{here}/campaign.yaml"}, "B3"),
    ],
)
def test_an_id_that_the_store_has_of_another_folder_holds_more(tmp_path: Path, held: dict[str, str], name: str) -> None:
    here = tmp_path / "hall/B3/raw"
    assert id_of(here, {i: path.format(here=here) for i, path in held.items()}) == name


def test_an_id_stays_where_a_folder_that_moved_is_drafted_anew(say: Say, tmp_path: Path) -> None:
    here = tmp_path / "hall/B3"
    here.mkdir(parents=True)
    _logged(here, "time [s];T_spindle [degC]")
    say("init", here)
    assert id_of(here, {"B3": "/elsewhere/campaign.yaml"}) == "B3"
