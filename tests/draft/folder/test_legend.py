"""A table that says what signals are, beside the logs or as a sheet among them: its words are names to guess by."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.commands import Say
from tests.draft.labs import workbook

LEGEND = [("Kanal", "Messstelle", "Einheit"), ("T01", "Spindellager vorn", "°C"), ("T02", "Maschinenbett", "°C")]
LEGEND += [("T03", "Hallenluft", "°C")]


def _logs(folder: Path) -> None:
    folder.mkdir(exist_ok=True)
    for day in (2, 3):
        rows = [f"2026-03-0{day} 08:{k:02d}:00;{21 + k / 20:.2f};{20 + k / 50:.2f};20.5{k % 3}" for k in range(60)]
        (folder / f"t{day}.csv").write_text("\n".join(["Zeit;T01;T02;T03", *rows, ""]), encoding="utf-8")


def _channels(folder: Path, say: Say) -> tuple[dict[str, Any], str]:
    assert say("init", folder).code == 0
    text = (folder / "campaign.yaml").read_text(encoding="utf-8")
    return {c["signal"]: c.get("at") for c in (yaml.safe_load(text)["channels"] or {}).values()}, text


def _write(folder: Path, rows: Sequence[Sequence[str]]) -> None:
    (folder / "legende.csv").write_text("".join(f"{';'.join(r)}\n" for r in rows), encoding="utf-8")


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0)])
def test_a_legend_beside_the_logs_is_guessed_by(tmp_path: Path, say: Say, order: Sequence[int]) -> None:
    _logs(tmp_path)
    _write(tmp_path, [[row[i] for i in order] for row in LEGEND])
    places, text = _channels(tmp_path, say)
    assert places == {"T01": "spindle.bearing.front", "T02": "bed", "T03": "hall"}
    assert "called 'Maschinenbett' in legende.csv" in text
    assert "# note: legende.csv says what signals are: T01 is 'Spindellager vorn'" in text
    assert "not used: legende.csv" not in text
    assert "sure:" not in text


@pytest.mark.parametrize(
    "rows",
    [
        [("Kanal", "Karte", "Einheit"), ("T01", "1", "°C"), ("T02", "2", "°C"), ("T03", "3", "°C")],
        [("Kanal", "Art", "Einheit"), ("T01", "Pt100", "°C"), ("T02", "Pt100", "°C"), ("T03", "Pt100", "°C")],
        [("Kanal", "Messstelle"), ("A1", "Spindellager vorn"), ("A2", "Maschinenbett"), ("A3", "Hallenluft")],
    ],
)
def test_numbers_one_word_and_other_names_are_none(tmp_path: Path, say: Say, rows: Sequence[Sequence[str]]) -> None:
    _logs(tmp_path)
    _write(tmp_path, rows)
    places, text = _channels(tmp_path, say)
    assert set(places.values()) <= {None}
    assert "says what signals are" not in text


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        (
            [
                "Setup of March",
                "",
                "Temperatures:",
                "  T01 Spindellager vorn",
                "  T02 Maschinenbett",
                "  T03 Hallenluft",
            ],
            True,
        ),
        (["Three runs, probes in volts. Ask Jan.", "T01 front spindle bearing; T02 = bed; T03: hall air. Enjoy"], True),
        (["Wir haben am Montag angefangen.", "Fühler: T01 = Spindellager vorn, T02 = Bett, T03 = Hallenluft"], True),
        (["What happened:", "T01 broke at noon, T02 fine since, T03 swapped with T01", "then lunch"], False),
        (["Notes of Jan", "T01 bed, T02 column", "and no more"], False),  # two
        (["Notes", "T01 bed, T02 column, T03 hall", "on Tuesday we moved T01", "T01 spindle bearing front"], False),
        (["Notes", "T01 bed 3000 rpm then, T02 column 20 degC, T03 hall 3 h long", "and more"], False),
        (["Runs", "A01 bed, A02 column, A03 hall", "and more"], False),
    ],
)
def test_names_in_the_prose_of_a_note_are_guessed_by(
    tmp_path: Path, say: Say, lines: Sequence[str], told: bool
) -> None:
    _logs(tmp_path)
    (tmp_path / "note.txt").write_text("\n".join([*lines, ""]), encoding="utf-8")
    places, text = _channels(tmp_path, say)
    assert places == ({"T01": "spindle.bearing.front", "T02": "bed", "T03": "hall"} if told else dict.fromkeys(places))
    assert ("# note: note.txt says what signals are: T01 is" in text) is told
    assert "sure:" not in text


TOLD = {"T01": ("spindle.bearing.front", "°F", None), "T02": ("bed", "°F", None), "T03": ("tcp", "mm", "X")}


@pytest.mark.parametrize(
    ("name", "lines"),
    [
        (
            "legende.csv",
            ["Kanal;Was;Einheit;Achse", "T01;Spindellager vorn;°F;", "T02;Bett;°F;-", "T03;Verlagerung TCP;mm;X"],
        ),
        ("legende.csv", ["Kanal;Was", "T01;Spindellager vorn [°F]", "T02;Bett [°F]", "T03;Verlagerung TCP [mm], X"]),
        ("legend.txt", ["T01 -> spindle bearing front [°F]", "T02 -> bed [°F]", "T03 -> displacement TCP [mm], X"]),
        (
            "legend.txt",
            ["Sensors", "T01 = spindle bearing front [°F]", "T02: bed [°F]", "T03 = displacement TCP X [mm]"],
        ),
    ],
)
def test_a_legend_tells_units_and_axes_too(tmp_path: Path, say: Say, name: str, lines: Sequence[str]) -> None:
    _logs(tmp_path)
    (tmp_path / name).write_text("\n".join([*lines, ""]), encoding="utf-8")
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    channels = yaml.safe_load(text)["channels"].values()
    assert {c["signal"]: (c.get("at"), c.get("unit"), c.get("axis")) for c in channels} == TOLD
    assert "in °F" in text
    assert "sure:" not in text


def test_the_unit_that_a_log_says_counts_more(tmp_path: Path, say: Say) -> None:
    _logs(tmp_path)
    for path in tmp_path.glob("t*.csv"):
        path.write_text(path.read_text().replace("T01", "T01 [degC]"))
    _write(tmp_path, [(n, w, "°F") for n, w, _ in LEGEND])
    assert say("init", tmp_path).code == 0
    channels = yaml.safe_load((tmp_path / "campaign.yaml").read_text())["channels"].values()
    assert {c["signal"]: c["unit"] for c in channels} == {"T01 [degC]": "degC", "T02": "°F", "T03": "°F"}


def test_a_sheet_is_one_too(tmp_path: Path, say: Say) -> None:
    times = [f"2026-03-02 08:{k:02d}:00" for k in range(60)]
    data = [("Zeit", "T01", "T02", "T03"), *((t, 21 + k / 20, 20 + k / 50, 20.5) for k, t in enumerate(times))]
    workbook(tmp_path / "log.xlsx", {"Daten": data, "Legend": LEGEND})
    places, text = _channels(tmp_path, say)
    assert set(places.values()) == {"spindle.bearing.front", "bed", "hall"}
    assert "called 'Hallenluft' in log.xlsx" in text


def test_a_table_of_tests_that_are_called_as_signals_is_no_legend(tmp_path: Path, say: Say) -> None:
    _logs(tmp_path)
    for name in ("T02", "T03"):
        (tmp_path / f"{name}.csv").write_bytes((tmp_path / "t2.csv").read_bytes().replace(b"2026-03-02", b"2026-04-02"))
    for name, called in (("t2", "T01"), ("t3", "other")):
        (tmp_path / f"{name}.csv").rename(tmp_path / f"{called}.csv")
    _write(tmp_path, [("Test", "Was"), *((name, text) for name, text, _ in LEGEND[1:])])
    channels, text = _channels(tmp_path, say)
    assert set(channels.values()) == {None}
    assert "says what signals are" not in text


LIST = ["Sensors:", "  T01: spindle bearing front", "  T02: bed", "  T03: hall air"]


@pytest.mark.parametrize(
    "above",
    [
        ["T02: bed under the table, glued on; drifts after the first hour."],
        ["Tests:", "  t2: 02.03.2026 08:00 to 09:00, for fitting", "  T03: 03.03.2026 08:00 to 09:00, for fitting"],
        ["T01 = 12.05.2025 exchanged"],
    ],
)
def test_a_signal_that_a_line_above_names_too_leaves_the_list_standing(
    tmp_path: Path, say: Say, above: Sequence[str]
) -> None:
    _logs(tmp_path)
    (tmp_path / "README.txt").write_text("\n".join(["Machine 4.", *above, *LIST, ""]), encoding="utf-8")
    places, text = _channels(tmp_path, say)
    assert places == {"T01": "spindle.bearing.front", "T02": "bed", "T03": "hall"}
    assert "called 'bed' in README.txt" in text
    assert "which is it?" not in text


def test_two_lines_that_disagree_are_asked_of_that_signal_alone(tmp_path: Path, say: Say) -> None:
    _logs(tmp_path)
    (tmp_path / "README.txt").write_text("\n".join([*LIST, "T02: column, rear", ""]), encoding="utf-8")
    places, text = _channels(tmp_path, say)
    assert places == {"T01": "spindle.bearing.front", "T02": "bed", "T03": "hall"}
    assert text.count("which is it? README.txt says 'bed' and 'column, rear'") == 1
    assert text.count("which is it?") == 1


def test_a_list_of_what_happened_to_sensors_is_no_legend(tmp_path: Path, say: Say) -> None:
    _logs(tmp_path)
    happened = ["T01: came loose", "T01: glued on again", "T02: cable exchanged", "T02: came loose", "T03: moved"]
    (tmp_path / "README.txt").write_text("\n".join([*happened, ""]), encoding="utf-8")
    _, text = _channels(tmp_path, say)
    assert "says what signals are" not in text


def test_a_text_that_says_what_signals_are_says_what_tests_are_too(tmp_path: Path, say: Say) -> None:
    _logs(tmp_path)
    plan = ["Tests:", "  t2: 02.03.2026, for fitting", "  t3: 03.03.2026, for checking"]
    (tmp_path / "README.txt").write_text("\n".join([*plan, *LIST, ""]), encoding="utf-8")
    places, text = _channels(tmp_path, say)
    assert places == {"T01": "spindle.bearing.front", "T02": "bed", "T03": "hall"}
    assert "README.txt says '02.03.2026, for fitting'" in text


@pytest.mark.parametrize(
    ("called", "described", "at"),
    [
        ("T_SpKa", "Spindelkasten oben", "headstock"),
        ("Spdl_2", "spindle front bearing", "spindle.bearing.front"),
        ("Spdl_3", "spindle", "spindle"),
        ("Spdl_motor", "spindle", "spindle.motor"),
        ("brg_f", "front bearing, ram nose", "spindle.bearing.front"),
        ("tbl_1", "rotary table bearing", "table.bearing"),
        ("palier_A", "palier berceau A", "rotary.a"),
        ("B_brg", "B axis bearing", "rotary.b"),
        ("T_Halle", "Halle, 1,5 m hoch", "hall"),
    ],
)
def test_what_a_legend_says_counts_more_than_the_name(
    tmp_path: Path, say: Say, called: str, described: str, at: str
) -> None:
    _logs(tmp_path)
    for path in tmp_path.glob("t*.csv"):
        path.write_text(path.read_text().replace("T01", f"{called} [degC]"))
    (tmp_path / "README.txt").write_text(f"{called}: {described}\nT02: bed\nT03: hall air\n", encoding="utf-8")
    places, text = _channels(tmp_path, say)
    assert places[f"{called} [degC]"] == at
    line = next(line for line in text.splitlines() if f'signal: "{called} [degC]"' in line)
    assert "# guess: name and unit" in line


def test_words_with_a_name_in_brackets_in_any_text_are_those_of_the_channel(tmp_path: Path, say: Say) -> None:
    """With the place that stands behind them."""
    _logs(tmp_path)
    said = ["Series 3, portal machine (linear motors)", "Tests:", "  t2: day, calibration", "Sensors:"]
    said += ["  Querbalken hinten  (T01): crossbeam.rear", "  Bett oben  (T02): bed.top", "  Halle (T03): hall"]
    (tmp_path / "README.txt").write_text("\n".join(said), encoding="utf-8")
    places, text = _channels(tmp_path, say)
    assert places == {"T01": "crossbeam.rear", "T02": "bed.top", "T03": "hall"}
    assert "called 'Querbalken hinten' in README.txt" in text
