"""Channels of a logger that its file calls something: the draft reads what they are called, and names them so."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.commands import Say
from thermodata.draft.signals.guess import called, guess_of
from thermodata.plugin import Signal
from thermodata.schema.files.load import load_campaign


def hioki(path: Path, comments: Sequence[str], day: int) -> None:
    said = ",".join(f'"{c}"' for c in comments)
    head = f'"HIOKI LR8450","Ver 2.10"\n"Comment",{said}\n"Time","U1-1[°C]","U1-2[°C]","U1-3[°C]"\n'
    rows = [
        f'"2026-02-{day:02} 21:{i // 6:02}:{i % 6 * 10:02}",{22 + i / 90},{21 + i / 99},{20 + i % 3 / 10}'
        for i in range(300)
    ]
    path.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")


def test_comments_name_the_channels_and_say_where_they_are(tmp_path: Path, say: Say) -> None:
    for day in (13, 14):
        hioki(tmp_path / f"day{day}.csv", ("Lager vorne", "Spindelgehäuse", "Raumluft"), day)
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    found = {n: (c.signal, c.quantity, c.at) for n, c in load_campaign(path).channels.items()}
    assert found == {
        "Lager_vorne": ("U1-1[°C]", "temperature", "spindle.bearing.front"),
        "Spindelgehause": ("U1-2[°C]", "temperature", "headstock"),
        "Raumluft": ("U1-3[°C]", "temperature", "hall"),
    }
    assert "called 'Lager vorne' in the file" in path.read_text()
    assert json.loads(say("--store", tmp_path / "s", "ingest", path, "--json").out)["losses"] == []


def test_a_channel_that_the_files_call_by_different_names_is_asked(tmp_path: Path, say: Say) -> None:
    hioki(tmp_path / "day13.csv", ("Lager vorne", "Lager hinten", "Raumluft"), 13)
    hioki(tmp_path / "day14.csv", ("Lager hinten", "Lager hinten", "Raumluft"), 14)
    assert say("init", tmp_path).code == 0
    (asked,) = [line for line in (tmp_path / "campaign.yaml").read_text().splitlines() if "U1-1" in line]
    assert "? the same in all tests? the files call it 'Lager vorne' (1), 'Lager hinten' (1)" in asked


@pytest.mark.parametrize(
    ("name", "description", "expected"),
    [
        ("CH1", "Spindle front", "CH1/Spindle front"),
        ("U1-1[°C]", "Lager v/h", "U1-1/Lager v h"),
        ("T_front", "new since May", "new since May/T_front"),
        ("T_front", "", "T_front"),
    ],
)
def test_a_description_counts_more_than_an_address_and_less_than_a_name(
    name: str, description: str, expected: str
) -> None:
    properties = {"description": description} if description else {}
    assert called(Signal(name, "table", None, properties=properties)) == expected


def test_a_value_under_a_head_is_called_as_the_head_and_has_its_unit(tmp_path: Path, say: Say) -> None:
    rows = [f"2026-04-20 08:{i // 6:02}:{i % 6 * 10:02},{75 + i / 50}" for i in range(300)]
    ended = [f",2026-04-20 08:{i:02}:00,{3000 + i % 3}" if i < 50 else ",," for i in range(300)]
    head = "MC7:BRG_FRONT_TEMP (DEG F),,MC7:SPINDLE_SPEED (RPM),\nTimestamp,Value,Timestamp,Value\n"
    (tmp_path / "day.csv").write_text(head + "".join(a + b + "\n" for a, b in zip(rows, ended, strict=True)))
    assert say("init", tmp_path).code == 0
    found = load_campaign(tmp_path / "campaign.yaml").channels
    assert {n: (c.quantity, c.unit) for n, c in found.items()} == {
        "MC7_BRG_FRONT_TEMP": ("temperature", "DEG F"),
        "MC7_SPINDLE_SPEED": ("rotational_speed", "RPM"),
    }


def test_comments_above_a_table_name_its_channels_and_a_test_that_lacks_one_is_asked(tmp_path: Path, say: Say) -> None:
    called = {"a": ("Lager vorn", "Lager hinten", "Bett"), "b": ("Lager vorn", "Bett")}
    for day, (test, names) in enumerate(called.items(), 5):
        head = [f"# Kanal {k}: {name}" for k, name in enumerate(names, 1)]
        titles = ";".join(["Zeit", *(f"Kanal {k} [°C]" for k in range(1, len(names) + 1))])
        rows = [
            f"{day:02}.05.2026 06:{i // 6:02}:{i % 6 * 10:02};"
            + ";".join(f"{21 + k + i / 90:.2f}" for k in range(len(names)))
            for i in range(300)
        ]
        (tmp_path / f"{test}.csv").write_text("\n".join([*head, titles, *rows, ""]), encoding="utf-8")
    assert say("init", tmp_path).code == 0
    channels = (tmp_path / "campaign.yaml").read_text().splitlines()
    (front,) = [line for line in channels if "Kanal 1" in line]
    (second,) = [line for line in channels if "Kanal 2" in line]
    assert "called 'Lager vorn' in the file" in front
    assert "? the same in all tests? the files call it 'Lager hinten' (1), 'Bett' (1)" in second


@pytest.mark.parametrize(
    ("said", "name", "quantity"),
    [("V", "S1", "voltage"), ("mV", "S1", "voltage"), ("V", "T_bed", "temperature"), ("VA", "S1", None)],
)
def test_volts_that_are_all_that_a_file_says_of_a_signal_are_its_unit(
    said: str, name: str, quantity: str | None
) -> None:
    found = guess_of(Signal(name, "ai", None, properties={"description": said}))
    assert found.quantity == quantity
    if quantity == "voltage":
        assert found.unit == said
