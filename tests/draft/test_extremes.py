"""Of a mean with its minimum and maximum the mean is the channel."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ..commands import Say


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
