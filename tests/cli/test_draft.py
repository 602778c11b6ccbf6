from __future__ import annotations

from dataclasses import replace
from pathlib import Path, PurePosixPath

import pytest
import yaml

from thermodata.cli.draft import RawFile, common_tail, draft, group, template_of
from thermodata.cli.naming import channel_name, guess, words
from thermodata.plugin import Recording, Signal
from thermodata.schema.campaign import Campaign
from thermodata.schema.load import load_campaign

DAQ = (Signal("Eddy/Z", "daq", "V"), Signal("Temp/T_bearing_front", "daq", "degC"), Signal("Temp/T14", "daq", "degC"))
NC = (Signal("nActSpeed", "nc", "1/min"), Signal("bDoor", "nc", None, "bool"), Signal("prog", "nc", None, "str"))


def raw(path: str, reader: str, signals: tuple[Signal, ...]) -> RawFile:
    return RawFile(PurePosixPath(path), reader, Recording(signals, "absolute"))


@pytest.mark.parametrize(("name", "unit", "dtype", "quantity", "at"), [
    ("T_bearing_front", "degC", "float64", "temperature", "spindle.bearing.front"),
    ("Lager vorn", "°C", "float64", "temperature", "spindle.bearing.front"),
    ("ložisko zadní", "degC", "float64", "temperature", "spindle.bearing.rear"),
    ("T_nut_Z", "degC", "float64", "temperature", "axis.z.nut"),
    ("Motor X", "degC", "float64", "temperature", "axis.x.motor"),
    ("Umgebung unten", "Grd C", "float64", "temperature", "hall.bottom"),
    ("teplota okolí nahoře", "°C", "float64", "temperature", "hall.top"),
    ("Spindeldrehzahl", "U/min", "float64", "rotational_speed", "spindle"),
    ("otáčky", "ot/min", "float64", "rotational_speed", "spindle"),
    ("Vorschub", "mm/min", "float64", "feed", None),
    ("Eddy/Z", "V", "float64", "displacement", "tcp"),
    ("výkon vřetena", "kW", "float64", "power", "spindle"),
    ("bDoor", None, "bool", "state", "hall.door"),
    ("program", None, "str", "label", None),
    ("PL", "mbar", "float64", "pressure", None),
    ("weight", "g", "float64", None, None),
    ("share", "%", "float64", "load", None),
])
def test_names_of_three_languages_are_understood(
    name: str, unit: str | None, dtype: str, quantity: str | None, at: str | None
) -> None:
    found = guess(name, unit, dtype)
    assert (found.quantity, found.at) == (quantity, at)


def test_what_is_not_sure_is_a_doubt() -> None:
    assert guess("T14", "degC").doubts == ("at: where on the machine?",)
    assert guess("Eddy/Z", "V").doubts == ()
    assert "axis?" in guess("Eddy/1", "V").doubts
    assert guess("ch7", "V").doubts == ("what does it measure? then: calibration",)


def test_words_come_apart() -> None:
    assert words("Eddy/nActSpeed_Z") == "eddy n act speed z"
    assert words("ŽluťoučkýKůň-Straße") == "zlutoucky kun strasse"


def test_channel_names_are_legal_and_unique() -> None:
    taken: set[str] = set()
    names = [channel_name(s, taken) for s in ("Eddy/Z", "Temp/T03", "TEMP/t03", "t", "3x", "ch3(um)", "ä ö")]
    assert names == ["Eddy_Z", "T03", "t03_2", "t_2", "ch_3x", "ch3", "a_o"]


def test_templates_need_one_folder_and_one_ending() -> None:
    assert template_of(["raw/a_daq.tdms", "raw/b_daq.tdms"]) == (
        "raw/{test}_daq.tdms", {"a": "raw/a_daq.tdms", "b": "raw/b_daq.tdms"})
    assert template_of(["raw/a.tdms", "other/b.tdms"])[0] is None
    assert common_tail(["heat", "beat"]) == ""


def test_a_template_that_would_catch_another_groups_file_is_not_used() -> None:
    groups = group([raw("raw/a.tdms", "crio", DAQ), raw("raw/b.tdms", "crio", NC)])
    assert [g.template for g in groups] == [None, None]


def test_a_draft_loads_and_marks_its_questions(tmp_path: Path) -> None:
    files = [raw("raw/etve_daq.tdms", "crio", DAQ), raw("raw/day1_daq.tdms", "crio", DAQ),
             raw("raw/etve.csv", "cnc", NC), raw("raw/day1.csv", "cnc", NC), raw("raw/jump_Z.tdms", "crio", DAQ[:1])]
    for f in files:
        (tmp_path / f.path).parent.mkdir(exist_ok=True)
        (tmp_path / f.path).touch()
    text = draft("hall-3", files, [("notes.txt", "no reader claims notes.txt")])
    (tmp_path / "campaign.yaml").write_text(text, encoding="utf-8")
    made = load_campaign(tmp_path / "campaign.yaml")
    assert isinstance(made, Campaign)
    assert [t.id for t in made.tests] == ["etve", "day1"] or [t.id for t in made.tests] == ["day1", "etve"]
    assert {t.id: t.role for t in made.tests} == {"etve": "calibration", "day1": "verification"}
    assert made.channels["Eddy_Z"].calibration == "jump_Eddy_Z"
    assert made.calibrations["jump_Eddy_Z"].kind == "jump"
    assert made.sources["crio"].files == "raw/{test}_daq.tdms"
    assert {c.quantity for c in made.channels.values()} == {"displacement", "temperature", "rotational_speed", "state",
                                                            "label"}
    assert next(line for line in text.splitlines() if "T14:" in line).endswith("# ? at: where on the machine?")
    assert "# not used: notes.txt" in text


def test_a_probe_gets_the_jump_test_of_its_axis_where_every_jump_test_logs_all_probes() -> None:
    probes = tuple(replace(DAQ[0], name=f"Eddy/{axis} vorn") for axis in "ZX")
    files = [raw("raw/a.tdms", "crio", probes), raw("raw/jump_x.tdms", "crio", probes),
             raw("raw/jump_z.tdms", "crio", probes)]
    lines = draft("lathe", files, []).splitlines()
    for axis in "ZX":
        line = next(x for x in lines if x.startswith(f"  jump_{axis}_vorn:"))
        assert f"file: raw/jump_{axis.lower()}.tdms" in line


@pytest.mark.parametrize("name", ["x: [1, 2]", "a # b", "'quoted\"", "{test}", "yes", "é/ž", "new\nline", "- dash"])
def test_any_name_survives_the_draft(name: str) -> None:
    text = draft("c", [raw("raw/a.tdms", "crio", (Signal(name, "s", "degC"),))])
    read = yaml.safe_load(text)
    assert [c["signal"] for c in read["channels"].values()] == [name]
