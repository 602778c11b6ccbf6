"""What texts beside the logs say is used, whatever they are called, laid out and encoded as."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from thermodata.draft.folder.beside.clock_said import offset_of
from thermodata.schema.files.load import load_campaign

_TABLE = """# Versuche

| Kanal | Bedeutung | Einheit |
|-------|:---------:|---------|
| CH1 | Lager vorn | °C |
| CH2 | Spindelmotor | °C |
| CH3 | Halle | °C |

NC-Zeit 40 s vor
"""


def _logs(folder: Path, *names: str) -> None:
    t = np.arange(0, 3600, 10.0)
    for k in range(3):
        rows = [f"{x:.0f}," + ",".join(f"{20 + i + 5 * x / (x + 900):.3f}" for i in range(len(names))) for x in t]
        (folder / f"W0{k}.csv").write_text("\n".join([f"t [s],{','.join(names)}", *rows, ""]), encoding="utf-8")


def _places(folder: Path, say: Say) -> tuple[dict[str, str | None], str]:
    """(signal -> its place, the draft)."""
    assert say("init", folder).code == 0
    path = folder / "campaign.yaml"
    return {str(c.signal): c.at for c in load_campaign(path).channels.values()}, path.read_text("utf-8")


@pytest.mark.parametrize("name", ["LIESMICH.md", "README.md"])
def test_a_table_of_markdown_says_what_signals_are_and_a_line_of_the_clock(name: str, tmp_path: Path, say: Say) -> None:
    _logs(tmp_path, "CH1", "CH2", "CH3")
    (tmp_path / name).write_text(_TABLE, encoding="utf-8")
    places, text = _places(tmp_path, say)
    assert places == {"CH1": "spindle.bearing.front", "CH2": "spindle.motor", "CH3": "hall"}
    assert f"# note: {name} says 'NC-Zeit 40 s vor': at the source of that clock, clock: {{offset: -40 s}}" in text


@pytest.mark.parametrize("encoding", ["utf-8", "cp932"])
def test_words_of_two_signs_say_what_a_signal_is(encoding: str, tmp_path: Path, say: Say) -> None:
    _logs(tmp_path, "CH1", "CH2", "CH3")
    told = "一覧\nCH1: 主軸前軸受 [℃]\nCH2: 主軸モータ [℃]\nCH3: 室温 [℃]\n"
    (tmp_path / "readme.txt").write_bytes(told.encode(encoding))
    assert _places(tmp_path, say)[0] == {"CH1": "spindle.bearing.front", "CH2": "spindle.motor", "CH3": "hall"}


@pytest.mark.parametrize(
    ("told", "place"),
    [
        ("T_x: Lager vorn\n", "spindle.bearing.front"),
        ("| Kanal | was |\n|---|---|\n| T_x | Lager vorn |\n", "spindle.bearing.front"),
        ("T_x: see the other list\n", None),  # no part of a machine
        ("T_x: Lager vorn\nstart: 8:00\nby: Novak\nfirst: W00\n", None),  # a note with more than names
    ],
)
def test_a_list_of_one_name(told: str, place: str | None, tmp_path: Path, say: Say) -> None:
    _logs(tmp_path, "T_air [degC]", "T_x [degC]")
    (tmp_path / "liesmich.txt").write_text(told, encoding="utf-8")
    assert _places(tmp_path, say)[0]["T_x [degC]"] == place


@pytest.mark.parametrize(
    ("sentence", "offset"),
    [
        ("NC-Zeit 40 s vor", "-40 s"),
        ("NC time 12 s behind", "12 s"),
        ("Steuerungsuhr geht vierzig Sekunden nach", "40 s"),
        ("CNC clock two minutes slow", "2 min"),
        ("the control clock is an hour ahead", "-1 h"),
        ("Die Uhr geht eine halbe Stunde vor", "-0.5 h"),
        ("hodiny jdou o dvě minuty napřed", "-2 min"),
        ("NC-Zeit 40 s vor dem Start gestellt", None),
        ("the clock was reset a minute before the test", None),
        ("clock one of two, slow", None),  # a number of anything else
    ],
)
def test_clocks_in_words(sentence: str, offset: str | None) -> None:
    assert offset_of(sentence) == offset
