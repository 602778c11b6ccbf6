"""Counters of milliseconds that nobody called a time, and that begin anew at 2^32."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import QuestionError
from thermodata.plugin import Source
from thermodata.testing.reader import load

ROLL = 2**32


def _asked(folder: Path, name: str, counts: Sequence[int], part: str = "ask") -> str:
    rows = [f"{n},{20 + k / 9:.3f},{21 + k / 50:.2f}" for k, n in enumerate(counts)]
    (folder / "a.csv").write_text("\n".join([f"{name},T1,T2", *rows, ""]), encoding="utf-8")
    with pytest.raises(QuestionError) as asked:
        load(Reader(), folder / "a.csv", Source())
    return str(getattr(asked.value, part))


@pytest.mark.parametrize(("name", "unit"), [("millis", "ms"), ("micros", "us"), ("millis()", "ms"), ("n", "ms")])
def test_a_counter_that_begins_anew_is_offered_as_the_time(tmp_path: Path, name: str, unit: str) -> None:
    asked = _asked(tmp_path, name, [(ROLL - 70_000 + 5000 * k) % ROLL for k in range(300)])
    assert f"is '{name}' the time, which begins anew behind 2^32?" in asked
    assert f"time: {{column: 1, unit: {unit}}}, and clock: {{resets: allow}}" in asked


def test_one_that_goes_on_is_offered_without(tmp_path: Path) -> None:
    asked = _asked(tmp_path, "millis", [5000 * k for k in range(300)])
    assert asked.endswith("or is 'millis' the time? then time: {column: 1, unit: ms}")
    assert "a column: {column: 1, unit: ms}" in _asked(tmp_path, "millis", [5000 * k for k in range(300)], "hint")


@pytest.mark.parametrize("fall", [10_000, 2**31 - 10_000, 2**32 + 10**6])
def test_other_falls_are_no_time(tmp_path: Path, fall: int) -> None:
    counts = np.arange(300) * 5000 + 5 * 10**9
    counts[100:] -= fall
    assert "the time?" not in _asked(tmp_path, "millis", counts.tolist())
