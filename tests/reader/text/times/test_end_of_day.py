"""24:00:00 at the end of a day is 00:00:00 of the next one, as ISO 8601 has it."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from thermodata.plugin import Block, Loss, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.times.in_memory import times_of_texts

AT = datetime(2026, 2, 28, 23, 50, tzinfo=UTC)
MINUTES = [AT + timedelta(minutes=k) for k in range(30)]


def written(moment: datetime, shape: str) -> str:
    """A time as loggers write it that know the end of a day."""
    if moment.hour or moment.minute or moment.second:
        return moment.strftime(shape)
    eve = (moment - timedelta(seconds=1)).replace(hour=0, minute=0, second=0)
    return eve.strftime(shape.replace("%H", "24"))


def read(path: Path, rows: list[str], head: str, source: Source) -> tuple[list[int], list[Loss]]:
    path.write_text("\n".join([f"{head};T [degC]", *(f"{r};{20 + k / 10}" for k, r in enumerate(rows)), ""]))
    items = list(delimited.blocks(path, delimited.open_table(path, source), source))
    t_ns = np.concatenate([b.t_ns for b in items if isinstance(b, Block)])
    return [int(t) // 10**9 for t in t_ns], [x for x in items if isinstance(x, Loss)]


@pytest.mark.parametrize(
    ("shape", "head", "declared"),
    [
        ("%Y-%m-%d %H:%M:%S", "time", None),
        ("%Y-%m-%dT%H:%M:%SZ", "time", None),
        ("%Y-%m-%d %H:%M:%S.000", "time", None),
        ("%d.%m.%Y %H:%M", "time", None),
        ("%d.%m.%Y;%H:%M:%S", "date;time", None),
        ("%d-%b-%Y %H:%M:%S", "time", "%d-%b-%Y %H:%M:%S"),
    ],
)
def test_the_end_of_a_day_is_the_beginning_of_the_next(
    tmp_path: Path, shape: str, head: str, declared: str | None
) -> None:
    rows = [written(m, shape) for m in MINUTES]
    assert any("24:00" in r for r in rows)
    table = {"time": {"format": declared}} if declared else None
    t, losses = read(tmp_path / "a.csv", rows, head, Source(timezone="UTC", table=table))
    assert t == [int(m.timestamp()) for m in MINUTES]
    assert losses == []


def test_times_of_day_go_on_over_it(tmp_path: Path) -> None:
    t, losses = read(tmp_path / "a.csv", [written(m, "%H:%M:%S") for m in MINUTES], "time", Source())
    assert t == [60 * k for k in range(30)]
    assert losses == []


def test_a_day_that_ends_with_it_is_one_of_its_date(tmp_path: Path) -> None:
    """Times of day below a date, from the first minute to the last, are no duration."""
    rows = [written(datetime(2026, 3, 1, tzinfo=UTC) + timedelta(minutes=10 * k), "%H:%M:%S") for k in range(1, 145)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["Date;2026-03-01", "time;T [degC]", *(f"{r};20.{k}" for k, r in enumerate(rows)), ""]))
    source = Source(timezone="UTC")
    table = delimited.open_table(path, source)
    t = np.concatenate([b.t_ns for b in delimited.blocks(path, table, source) if isinstance(b, Block)])
    assert len(t) == 144
    assert np.diff(t).tolist() == [600 * 10**9] * 143


@pytest.mark.parametrize("cell", ["2026-02-28 24:00:01", "2026-02-28 24:10:00", "2026-02-28 25:00:00"])
def test_what_is_past_the_end_of_a_day_is_lost(tmp_path: Path, cell: str) -> None:
    rows = [m.strftime("%Y-%m-%d %H:%M:%S") for m in MINUTES]
    rows[10] = cell
    t, losses = read(tmp_path / "a.csv", rows, "time", Source(timezone="UTC"))
    assert len(t) == 29
    assert len(losses) == 1


def test_durations_of_24_h_stay_durations(tmp_path: Path) -> None:
    rows = [f"{k // 6:02d}:{k % 6}0:00" for k in range(145)]
    t, losses = read(tmp_path / "a.csv", rows, "time", Source())
    assert t == [600 * k for k in range(145)]
    assert losses == []


def test_texts_in_memory_read_it_too() -> None:
    found = times_of_texts([written(m, "%Y-%m-%d %H:%M:%S") for m in MINUTES], "UTC", None, "a.parquet")
    assert [int(t) // 10**9 for t in found.t_ns] == [int(m.timestamp()) for m in MINUTES]
