"""A counter that is full begins anew, and its rows are counted on; a clock that is set back is none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited
from thermodata.reader.times.wrapped_counter import Counter


def read(folder: Path, counts: list[int], unit: str = "ms", block: int = 1 << 20) -> tuple[list[int], tuple[str, ...]]:
    """(times in units from the first, notes)"""
    path = folder / "log.csv"
    head = ["Start: 2026-03-02 08:00:00", f"Tick [{unit}];T1 [°C];T2 [°C]"]
    path.write_text("\n".join([*head, *(f"{n};20.{k % 9};21.{k % 7}" for k, n in enumerate(counts)), ""]), "utf-8")
    table = delimited.open_table(path, Source())
    times = np.concatenate([b.t_ns for b in delimited.blocks(path, table, Source()) if isinstance(b, Block)])
    each = {"ms": 10**6, "us": 10**3, "s": 10**9}[unit]
    return ((times - times[0]) // each).tolist(), delimited.describe(table, Source()).notes


@pytest.mark.parametrize(
    ("step", "full", "unit"),
    [(5000, 1 << 16, "ms"), (60_000, 1 << 16, "ms"), (250, 1 << 16, "s"), (10**8, 1 << 32, "us")],
)
def test_a_counter_that_is_full_is_counted_on(tmp_path: Path, step: int, full: int, unit: str) -> None:
    true = [step * k for k in range(400)]
    times, notes = read(tmp_path, [n % full for n in true], unit)
    assert times == true
    assert any(f"begins anew at {full}" in n for n in notes)


@pytest.mark.parametrize("back", [0, 60_000])
def test_a_clock_that_is_set_back_is_no_counter(tmp_path: Path, back: int) -> None:
    """Or one that stays below what it holds."""
    counts = [5000 * k - (back if k > 12 else 0) for k in range(13 if not back else 24)]
    times, notes = read(tmp_path, counts)
    assert times == counts
    assert not any("begins anew" in n for n in notes)


def test_a_counter_goes_on_from_chunk_to_chunk_and_over_rows_without_a_time() -> None:
    true = 5000.0 * np.arange(300)
    counts = true % 65_536
    counts[[40, 41]] = np.nan
    counter, out = Counter(), []
    for k in range(0, 300, 37):
        counter.gone_on(counts[k : k + 37], peek=True)
        out.append(counter.gone_on(counts[k : k + 37]))
    expected = np.where(np.isnan(counts), np.nan, true)
    np.testing.assert_array_equal(np.concatenate(out), expected)
