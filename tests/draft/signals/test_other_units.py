"""One file in another unit is asked by its name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.draft.labs import numbers, text
from thermodata.draft.make import draft_files
from thermodata.draft.signals.told_units.other_units import unit_question
from thermodata.draft.signals.values import values_of


@pytest.mark.parametrize(
    ("quantity", "scales", "asked_of"),
    [
        ("temperature", [(1.0, 22.0), (1.0, 24.0), (1.0, 295.0)], "t2"),
        ("temperature", [(1.0, 295.0), (1.0, 296.0)], None),
        ("temperature", [(1.0, 22.0), (1.0, 80.0)], None),
        ("displacement", [(1.0, 0.0), (0.7, 3.0), (1e-3, 0.0)], "t2"),
        ("displacement", [(1.0, 0.0), (0.2, 3.0), (5.0, 0.0)], None),
        ("rotational_speed", [(1.0, 0.0), (1e-3, 0.0)], None),
    ],
)
def test_a_file_in_another_unit_is_asked(
    quantity: str, scales: list[tuple[float, float]], asked_of: str | None
) -> None:
    noise = np.random.default_rng(1).normal(size=300) + np.linspace(0.0, 20.0, 300)
    asked = unit_question(quantity, {f"t{i}": values_of(level + k * noise) for i, (k, level) in enumerate(scales)})
    assert (asked is None) == (asked_of is None)
    assert asked is None or asked.startswith(f"unit: in {asked_of} values ")


def test_files_of_one_name_in_a_folder_each_are_told_apart(tmp_path: Path) -> None:
    t = np.arange(300) * 10.0
    for test, zero in (("a", 0.0), ("b", 273.15), ("c", 0.0)):
        columns = [numbers(t, 0), numbers(22 + zero + t / 1000, 3)]
        text(tmp_path / test / "data.csv", ["t [s]", "T_hall"], columns, mark=",")
    (hall,) = draft_files(tmp_path).draft.channels
    assert any(q.startswith("unit: in b/data.csv values 295") for q in hall.said.questions)


@pytest.mark.parametrize(("hall", "asked"), [(1.8, True), (1.0, False)])
def test_tests_in_fahrenheit_are_asked_and_one_that_was_warm_before_is_not(
    tmp_path: Path, hall: float, asked: bool
) -> None:
    """hall: by how much its numbers differ from degC; the bearing's are those of Fahrenheit in two tests of four."""
    t = np.arange(300) * 10.0
    for test, factor in (("a", 1.0), ("b", 1.0), ("c", 1.8), ("d", 1.8)):
        bearing, air = 22 + t / 300, 20.5 + t / 5000
        columns = [bearing * factor + 32 * (factor > 1)]
        own = hall if factor > 1 else 1.0
        columns.append(air * own + 32 * (own > 1))
        text(
            tmp_path / f"{test}.csv",
            ["t [s]", "T_bearing", "T_hall"],
            [numbers(t, 0), *(numbers(c, 3) for c in columns)],
            mark=",",
        )
    questions = {c.name: " ".join(c.said.questions) for c in draft_files(tmp_path).draft.channels}
    assert ("unit: in c.csv, d.csv values" in questions["T_bearing"]) is asked
    assert ("degF there" in questions["T_hall"]) is asked


@pytest.mark.parametrize(
    ("motor", "asked"),
    [
        ([lambda w: (21.1 + 14 * w) * 1.8 + 32, lambda w: (19.4 + 12 * w) * 1.8 + 32], True),
        # the nearest that are in degC: warm before one test, warm by another reading, kept warm, cold before
        ([lambda w: 70 + 20 * w, lambda w: 52 + 20 * w], False),
        ([lambda w: 76 + 20 * w, lambda w: 75 + 20 * w], False),
        ([lambda w: 70 + 0.4 * w, lambda w: 69 + 0.4 * w], False),
        ([lambda w: 21.1 + 50 * w, lambda w: 19.4 + 45 * w], False),
    ],
)
def test_one_in_fahrenheit_beside_others_in_degrees_is_asked_though_the_head_says_degrees(
    tmp_path: Path, motor: list[Callable[[Any], Any]], asked: bool
) -> None:
    t = np.arange(300) * 30.0
    warm = 1 - np.exp(-t / 3000)
    for k, (read, hall) in enumerate(zip(motor, (20.8, 19.2), strict=True)):
        parts = [hall + size * warm for size in (0.5, 4.0, 9.0)]
        columns = [numbers(t, 0), *(numbers(x, 2) for x in (*parts, read(warm)))]
        heads = ["t [s]", "T_hall [degC]", "T_bed [degC]", "T_nut_Z [degC]", "T_motor_Z [degC]"]
        text(tmp_path / f"run{k}.csv", heads, columns, mark=",")
    said = {c.name: [q for q in c.said.questions if q.startswith("unit")] for c in draft_files(tmp_path).draft.channels}
    assert bool(said.pop("T_motor_Z")) == asked
    assert not any(said.values())


def test_two_in_fahrenheit_do_not_silence_each_other(tmp_path: Path) -> None:
    t = np.arange(300) * 30.0
    warm = 1 - np.exp(-t / 3000)
    for k in range(2):
        parts = [20.5 + size * warm for size in (0.5, 4.0, 9.0)]
        others = [1.8 * (20.5 + size * warm) + 32 for size in (12.0, 8.0)]
        heads = ["t [s]", *(f"T_{x} [degC]" for x in ("hall", "bed", "nut_Z", "motor_Z", "motor_Y"))]
        text(tmp_path / f"run{k}.csv", heads, [numbers(t, 0), *(numbers(x, 2) for x in (*parts, *others))], mark=",")
    said = {c.name: [q for q in c.said.questions if "degF" in q] for c in draft_files(tmp_path).draft.channels}
    assert sorted(name for name, asked in said.items() if asked) == ["T_motor_Y", "T_motor_Z"]
    assert "as most others are (20.5 to 20.5)" in said["T_motor_Z"][0]
