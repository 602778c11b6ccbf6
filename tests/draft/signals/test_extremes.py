"""Of a mean with its minimum and maximum the mean is the channel."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.commands import Say


def drafted(folder: Path, say: Say, names: list[str], *, limits: bool = False) -> tuple[list[str], str]:
    """(signals that are channels, all that is written)"""
    rows = []
    for k in range(200):
        values = [5 * d if limits and d else k / 200 + d / 10 for d in (0, -1, 1)]
        cells = ";".join(f"{v:.3f}" for v in (*values, 20 + k / 50))
        rows.append(f"2026-03-13 08:{k // 60:02d}:{k % 60:02d};{cells}")
    (folder / "S4000.csv").write_text("\n".join([f"Time;{';'.join(names)};T_bed [degC]", *rows, ""]), "utf-8")
    assert say("init", folder).code == 0
    text = (folder / "campaign.yaml").read_text("utf-8")
    return re.findall(r'signal: "?([^",]+)"?,', text), text


@pytest.mark.parametrize(
    "names",
    [
        ["dX Mean [um]", "dX Min [um]", "dX Max [um]"],
        ["dX_avg [um]", "dX_min [um]", "dX_max [um]"],
        ["dX [um]", "dX_min [um]", "dX_max [um]"],
        ["dXMean [um]", "dXMin [um]", "dXMax [um]"],
        ["Mittelwert dX [um]", "Min dX [um]", "Max dX [um]"],
    ],
)
def test_the_mean_alone_is_a_channel(tmp_path: Path, say: Say, names: list[str]) -> None:
    signals, text = drafted(tmp_path, say, names)
    assert signals == [names[0], "T_bed [degC]"]
    assert f"{names[1]}, {names[2]}: left out" in text


@pytest.mark.parametrize(
    "names", [["dX Mean [um]", "dY Min [um]", "dZ Max [um]"], ["dZ [um]", "dX Min [um]", "dY [um]"]]
)
def test_one_without_the_others_is_a_channel(tmp_path: Path, say: Say, names: list[str]) -> None:
    assert drafted(tmp_path, say, names)[0] == [*names, "T_bed [degC]"]


def test_limits_beside_a_reading_are_none_of_its_extremes(tmp_path: Path, say: Say) -> None:
    names = ["dX [um]", "dX_min [um]", "dX_max [um]"]
    assert drafted(tmp_path, say, names, limits=True)[0] == [*names, "T_bed [degC]"]


def test_the_last_reading_of_a_mean_is_no_channel_beside_it(tmp_path: Path, say: Say) -> None:
    """Campbell's tables: T_Avg, T_Last; what alone is called the last is the reading."""
    head = [
        '"TOA5","CR","CR1000X"',
        '"TIMESTAMP","RECORD","T_bed_Avg","T_bed_Last","dX_Last"',
        '"TS","RN","Deg C","Deg C","um"',
        '"","","Avg","Last","Last"',
    ]
    rows = (f'"2026-03-13 08:{k:02d}:00",{k},{20 + k / 50:.2f},{20 + k / 49:.2f},{k / 9:.3f}' for k in range(60))
    (tmp_path / "S4000.dat").write_text("\n".join([*head, *rows, ""]), "utf-8")
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text("utf-8")
    assert re.findall(r"^  \w+: {source: log, signal: (\w+), quantity: \w", text, re.MULTILINE) == [
        "T_bed_Avg",
        "dX_Last",
    ]
    assert "T_bed_Last: left out" in text
