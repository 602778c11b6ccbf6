"""A scale that a file states and nobody applies is asked, with the unit that has it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from thermodata.draft.signals.guess import guess_of
from thermodata.draft.signals.scale_said import with_scale_asked
from thermodata.plugin import Scaling, Signal

from .conftest import Said

Say = Callable[..., Said]


@pytest.mark.parametrize(
    ("head", "asked"),
    [
        ("Channel;1;2\nName;T_front;dZ\nUnit;degC;um\nGain;1;0.1\nDate/Time;CH1;CH2", "'Gain = 0.1'"),
        ("Name;T_front;dZ\nUnit;degC;um\nSlope;1;0.1\nDate/Time;CH1;CH2", "'Slope = 0.1'"),
        ("Kanal;CH1;CH2\nName;T_front;dZ\nEinheit;degC;um\nFaktor;1;0,1\nDatum/Zeit;CH1;CH2", "'Faktor = 0,1'"),
        ("# dZ: 1 digit = 0.1 um\nTime;T_front [degC];dZ [um]", "'1 digit = 0.1'"),
        ("Time;T_front [degC];dZ [um]\nScale;1;0.1", "'Scale = 0.1'"),
    ],
)
def test_a_scale_of_the_head_is_asked_of_its_column_alone(tmp_path: Path, say: Say, head: str, asked: str) -> None:
    rows = [f"2026-03-12 08:{k:02d}:00;{20 + k / 7:.2f};{4 + 3 * k}" for k in range(60)]
    (tmp_path / "run1.csv").write_text("\n".join([head, *rows, ""]), encoding="utf-8")
    assert say("init", tmp_path).code in (0, 3)
    lines = (tmp_path / "campaign.yaml").read_text(encoding="utf-8").splitlines()
    told = [line for line in lines if f"the file says {asked}" in line]
    assert len(told) == 1
    assert "quantity: displacement" in told[0]
    assert 'unit: "0.1 um", instead_of: um' in told[0]


def test_properties_of_a_signal_that_scale_it_are_asked_unless_its_reader_applies_them() -> None:
    said = {"Factor": "0.1", "Offset": "-5.0", "Polarity": "inverted"}
    signal = Signal("Log/dZ", "log", "um", "float64", properties=said)
    comment = with_scale_asked(guess_of(signal), signal).comment()
    assert all(f"'{key} = {value}'" in comment for key, value in said.items())
    applied = Signal("Log/dZ", "log", "um", "float64", Scaling("linear", {"gain": 0.1, "offset": 0.0}), properties=said)
    assert with_scale_asked(guess_of(applied), applied) == guess_of(applied)
    plain = Signal("Log/dZ", "log", "um", "float64", properties={"Factor": "1", "Offset": "0", "Polarity": "normal"})
    assert with_scale_asked(guess_of(plain), plain) == guess_of(plain)


@pytest.mark.parametrize("head", ["Gain;inf;1;1", "Gain;1e-300;1;1", "Gain;10", "Offset;-5", "Zero;true;true;true"])
def test_what_is_no_scale_of_a_column_is_not_asked_of_one(tmp_path: Path, say: Say, head: str) -> None:
    rows = [f"2026-03-12 08:{k:02d}:00;{20 + k / 7:.2f};{4 + 3 * k};{k}" for k in range(60)]
    names = "Time;T_front [degC];dZ [um];T_rear [degC]"
    (tmp_path / "run1.csv").write_text("\n".join([head, names, *rows, ""]), encoding="utf-8")
    assert say("init", tmp_path).code in (0, 3)
    assert "the file says" not in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
