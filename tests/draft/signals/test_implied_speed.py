"""A speed whose unit nothing says, or what the file says of the signal: rad/s and deg/s are no rpm."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.draft.signals.guess import guess_of
from thermodata.draft.signals.values import Values
from thermodata.plugin import Signal

RANGE = Values(1000, 0.0, 628.3, 100.0, 1.0, 0.1, 9, False, 0.0, 0.0)
PATH = "/Nck/!SD/nckServoDataActVelMot64 [u1; 5]"


def signal(name: str, unit: str | None = None, **properties: str) -> Signal:
    return Signal(name, "s", unit, "float64", None, properties)


@pytest.mark.parametrize(
    ("of", "unit", "asks"),
    [
        (signal("/spindle.velocity"), "rpm", True),
        (signal("spindle/rotation_speed/vel"), "rpm", True),
        (signal("/sp.speed", schema="spindle_msgs/State"), "rpm", True),  # a message, as MCAP holds it
        (signal("/sp.speed_rpm", schema="spindle_msgs/State"), "rpm", False),
        (signal("Spindle velocity", "rad/s"), "rad/s", False),
        (signal("Spindle speed"), "rpm", False),
        (signal("S1 spindle velocity", type="RotaryVelocity", dataItemId="s1"), "rpm", False),  # the standard says it
        (signal(PATH, description="Istdrehzahl Spindel Grad/s"), "Grad/s", False),
        (signal(PATH, description="Istdrehzahl Spindel [1/min]"), "1/min", False),
        (signal(PATH, description="Istdrehzahl Spindel mm/s"), "rpm", True),  # of another quantity
        (signal(PATH, description="Istdrehzahl Spindel"), "rpm", True),
    ],
)
def test_the_unit_of_a_speed_is_read_or_asked(of: Signal, unit: str, asks: bool) -> None:
    found = guess_of(of, RANGE)
    assert (found.quantity, found.unit) == ("rotational_speed", unit)
    assert any("rad/s or deg/s?" in q for q in found.questions) is asks
    assert not (asks and found.sure)


@pytest.mark.parametrize(
    ("name", "comment"),
    [
        ("Spindle velocity", "speed guess: data, in rpm by its values"),
        ("Spindle speed", "speed guess: data, in rpm by its values"),
        ("Spindle speed [rpm]", "speed sure: data"),
    ],
)
def test_the_speed_of_a_test_is_sure_only_where_its_unit_is_said(tmp_path: Path, name: str, comment: str) -> None:
    rows = [
        f"2026-03-02T{8 + k // 360:02d}:{k // 6 % 60:02d}:{k % 6 * 10:02d}Z,{523.6 if k > 200 else 0},20.{k % 9}"
        for k in range(1440)
    ]
    (tmp_path / "a.csv").write_text("\n".join([f"time,{name},T_bed [degC]", *rows, ""]))
    draft = draft_files(tmp_path).draft
    assert comment in draft.tests[0].kind.comment
    (channel,) = [c for c in draft.channels if "pindle" in c.name]
    assert any("rad/s" in q for q in channel.said.questions) is ("velocity" in name)
