"""Columns that a logger adds, switches in words, and a speed that nobody's words explain."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from thermodata.draft.make import draft_files
from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import values_of
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.load import load_campaign

N = 120
WAVE = [f"{20 + i / 50:.2f}" for i in range(N)]


def log(path: Path, columns: Mapping[str, Sequence[object]], day: int = 2) -> None:
    times = [f"2026-03-{day:02} {8 + i // 60:02}:{i % 60:02}:00" for i in range(N)]
    rows = zip(times, *columns.values(), strict=True)
    lines = [",".join(("time", *columns)), *(",".join(map(str, row)) for row in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def drafted(folder: Path, say: Say) -> tuple[Campaign, str]:
    assert say("init", folder).code == 0
    path = folder / "campaign.yaml"
    return load_campaign(path), path.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "column", "said"),
    [
        ("Scan", np.arange(1, 61), "no reading: it counts the rows"),
        ("Reading", np.arange(0.0, 60.0), "no reading: it counts the rows"),
        ("No.", np.arange(1, 61), "no reading: it counts the rows"),
        ("Scan", np.arange(5, 165), "? quantity and unit? (values 5 to 164)"),
        ("Reading", np.arange(0, 120, 2), "? quantity and unit? (values 0 to 118)"),
        ("Reading", np.r_[np.arange(1, 30), np.arange(31, 61)], "? quantity and unit? (values 1 to 60)"),
    ],
)
def test_a_column_that_counts_the_rows_is_asked_of_nobody(name: str, column: np.ndarray, said: str) -> None:  # type: ignore[type-arg]
    assert guess(name, None, "float64", values_of(column)).comment() == said


def test_what_counts_up_by_its_name_is_what_the_name_says() -> None:
    assert guess("Temp hall", None, "float64", values_of(np.arange(1.0, 61.0))).quantity == "temperature"


@pytest.mark.parametrize(
    ("words", "quantity"),
    [
        (("ON", "OFF"), "state"),
        (("ein", "aus"), "state"),
        (("OFF", "OFF"), "state"),
        (("ON", "AUTO"), "label"),
        (("", ""), "label"),
    ],
)
def test_words_of_a_switch_are_a_state(words: tuple[str, str], quantity: str) -> None:
    seen = values_of(np.array([*words] * 20, dtype=object))
    assert guess("Coolant", None, "str", seen).quantity == quantity


def test_a_status_of_readings_stays_one() -> None:
    seen = values_of(np.array(["true", "false"] * 20, dtype=object))
    assert guess("Status", None, "str", seen).quantity == "label"


def test_a_switch_in_words_is_read_as_0_and_1(tmp_path: Path, say: Say) -> None:
    log(tmp_path / "a.csv", {"Coolant": ["OFF", "ON"] * (N // 2), "T_hall": WAVE})
    campaign, _ = drafted(tmp_path, say)
    coolant = campaign.channels["Coolant"]
    assert (coolant.quantity, coolant.at) == ("state", "coolant")
    store = ("--store", tmp_path / "s")
    assert say(*store, "ingest", tmp_path / "campaign.yaml").code == 0
    asked = "select min(value) as low, max(value) as high, count(*) as n from sample where channel = 'Coolant'"
    assert json.loads(say(*store, "sql", asked, "--json").out) == [{"low": 0.0, "high": 1.0, "n": N}]


def test_words_that_are_no_switch_in_one_test_are_none_in_any(tmp_path: Path, say: Say) -> None:
    log(tmp_path / "a.csv", {"Modus": ["OFF"] * N, "T_hall": WAVE})
    log(tmp_path / "b.csv", {"Modus": ["OFF", "AUTO"] * (N // 2), "T_hall": WAVE}, 3)
    campaign, _ = drafted(tmp_path, say)
    assert campaign.channels["Modus"].quantity == "label"


@pytest.mark.parametrize(("name", "drafted_as"), [("$RT_OFF$", None), ("$RT_DIS$", None), ("RT_OFF", "state")])
def test_marks_of_wincc_are_no_states(name: str, drafted_as: str | None) -> None:
    found = guess(name, None, "float64", values_of(np.array([0.0, 1.0] * 20)))
    assert found.quantity == drafted_as
    assert ("no reading: WinCC" in found.comment()) is (drafted_as is None)


@pytest.mark.parametrize(
    ("speeds", "is_speed"),
    [((8000, 12000), True), ((8000, 11000), False), ((8000, 0), False)],
)
def test_a_column_with_the_speeds_of_the_names_is_the_speed(
    tmp_path: Path, say: Say, speeds: tuple[int, int], is_speed: bool
) -> None:
    for day, (named, reached) in enumerate(zip((8000, 12000), speeds, strict=True), 2):
        turns = [0] * 20 + [reached] * (N - 20)
        log(tmp_path / f"sp{named}.csv", {"Velocidad": turns, "T_hall": WAVE}, day)
    campaign, text = drafted(tmp_path, say)
    if is_speed:
        channel = campaign.channels["Velocidad"]
        assert (channel.quantity, channel.unit, channel.at) == ("rotational_speed", "rpm", "spindle")
    else:
        assert "Velocidad" not in campaign.channels
    assert ("nobody logged the speed" in text) is not is_speed


def test_two_columns_with_those_speeds_are_asked(tmp_path: Path, say: Say) -> None:
    for day, named in enumerate((8000, 12000), 2):
        turns = [0] * 20 + [named] * (N - 20)
        log(tmp_path / f"sp{named}.csv", {"Velocidad": turns, "Consigna": turns, "T_hall": WAVE}, day)
    campaign, _ = drafted(tmp_path, say)
    assert list(campaign.channels) == ["T_hall"]


def test_numbers_of_tags_and_qualities_of_columns_are_no_channels(tmp_path: Path, say: Say) -> None:
    tags = ("T_front", "speed")
    head = ",".join(f"{k}_NUMERICID,{k}_VALUE,{k}_TIMESTAMP,{k}_QUALITY" for k in tags) + "\n"
    rows = (
        f"7,{20 + i / 50:.2f},2026-04-17 08:{i // 60:02}:{i % 60:02},192,"
        f"8,{3000 * (i > 30)},2026-04-17 08:{i // 60:02}:{i % 60:02},192\n"
        for i in range(120)
    )
    (tmp_path / "R1.csv").write_text(head + "".join(rows))
    campaign, text = drafted(tmp_path, say)
    assert {c.signal for c in campaign.channels.values()} == {"T_front_VALUE", "speed_VALUE"}
    assert "NUMERICID: {" not in text


def test_a_quality_that_flags_nothing_and_a_number_that_changes_are_asked(tmp_path: Path, say: Say) -> None:
    rows = (f"2026-04-17 08:{i // 60:02}:{i % 60:02},{20 + i / 50:.2f},{i // 7 + 3},192\n" for i in range(120))
    (tmp_path / "R1.csv").write_text("time,T_front,tag_id,weld_quality\n" + "".join(rows))
    _, text = drafted(tmp_path, say)
    assert "# tag_id: {" in text
    assert "# weld_quality: {" in text


def test_what_was_asked_of_influxdb_is_no_channel(tmp_path: Path) -> None:
    head = (
        "#group,false,false,true,true,false,true,false,false\n"
        "#datatype,string,long,dateTime:RFC3339,dateTime:RFC3339,dateTime:RFC3339,string,double,double\n"
        "#default,_result,,,,,,,\n"
        ",result,table,_start,_stop,_time,host,dz_um,t_bed\n"
    )
    span = "2026-05-18T06:00:00Z,2026-05-18T08:00:00Z"
    rows = [
        f",,0,{span},2026-05-18T06:{k // 60:02d}:{k % 60:02d}Z,edge1,{k / 9:.3f},{20 + k / 90:.3f}" for k in range(200)
    ]
    (tmp_path / "p1.csv").write_text(head + "\n".join([*rows, ""]))
    draft = draft_files(tmp_path).draft
    assert [c.signal for c in draft.channels] == ["host", "dz_um", "t_bed"]
    assert any("left out, for they say what was asked of InfluxDB" in note for note in draft.notes)
