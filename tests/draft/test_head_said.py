"""What the head of a file says of units stands beside the question of a unit."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from .conftest import Said

Say = Callable[..., Said]


@pytest.mark.parametrize(
    ("head", "asked"),
    [
        (
            "Temperature scale: Fahrenheit\n\nDate Time,T_bed,T_column",
            "the head of the file says 'Temperature scale: F",
        ),
        ("Units: INCH / DEG F\n\nDate Time,T_bed,Z probe", "the head of the file says 'Units: INCH / DEG F'"),
        ('"Scaling","CH1","Ratio","100","um"\n\n"Date Time","CH1[V]","T_bed"', "says 'Scaling CH1 Ratio 100 um'"),
        ("Operator: Smith\n\nDate Time,T_bed,T_column", ""),
    ],
)
def test_units_of_the_head_are_quoted(tmp_path: Path, say: Say, head: str, asked: str) -> None:
    rows = [f"2026-03-12 08:{k:02d}:00,{45 + k / 7:.2f},{0.01 + k / 900:.5f}" for k in range(60)]
    (tmp_path / "run1.csv").write_text("\n".join([head, *rows, ""]), encoding="utf-8")
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert asked in text if asked else "the head of the file" not in text
