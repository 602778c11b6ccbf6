"""A stroke within brackets is a unit's, and parts no path of names: the channel is called by the words before it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from tests.draft.labs import numbers, text
from thermodata.draft.signals.guess import guess
from thermodata.draft.words.naming import parts_of
from thermodata.schema.files.load import load_campaign


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("Temp/T06", ["Temp", "T06"]),
        ("/hall/air.top", ["hall", "air.top"]),
        ("Strokes (x/zz)", ["Strokes (x/zz)"]),
        ("Daq [a/b]/Strokes (x/zz)", ["Daq [a/b]", "Strokes (x/zz)"]),
        ("Daq (a/Strokes", ["Daq (a", "Strokes"]),  # which nothing closes
        ("", [""]),
    ],
)
def test_a_name_comes_apart_at_strokes_outside_of_brackets(name: str, parts: list[str]) -> None:
    assert parts_of(name) == parts


@pytest.mark.parametrize("unit", ["(x/zz)", "(xx/zz)"])
def test_an_unknown_unit_in_brackets_names_no_channel(tmp_path: Path, say: Say, unit: str) -> None:
    t = np.arange(200) * 30.0
    for k in (1, 2):
        columns = [numbers(t, 0), numbers(20 + t / 900, 2), numbers(1200 + 0 * t, 0), numbers(t / 300, 2)]
        header = ["t [s]", f"Front bearing {unit}", f"Spindle speed {unit}", "Fast/Displ. Z [um]"]
        text(tmp_path / f"run_{k}.csv", header, columns, mark=",")
    say("init", tmp_path)
    named = load_campaign(tmp_path / "campaign.yaml").channels
    letters = unit[1:-1].replace("/", "_")
    assert {f"Front_bearing_{letters}", f"Spindle_speed_{letters}", "Displ_Z"} == set(named)


def test_what_stands_before_the_brackets_tells_quantity_and_place() -> None:
    found = guess("X ilerleme (mm/zz)", None)
    assert (found.quantity, found.at) == ("feed", "axis.x")
    assert guess("Fast/X feed", "m/min").at == "axis.x"
