"""Times at second 60, of clocks with leap seconds and of programs that round: the minute after, counted and told."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from thermodata.plugin import Block, Loss, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.times.in_memory import times_of_texts

AT = datetime(2016, 12, 31, 23, 59, 40, tzinfo=UTC)
N = 60


def stamps(zone: str = "", shape: str = "%Y-%m-%d %H:%M:%S") -> list[str]:
    """Rows each second over the leap second at the end of 2016, as a clock of GPS writes them."""
    before = [(AT + timedelta(seconds=k)).strftime(shape) for k in range(20)]
    leap = before[-1].replace("59:59", "59:60")
    after = [(AT + timedelta(seconds=20 + k)).strftime(shape) for k in range(N - 21)]
    return [s + zone for s in (*before, leap, *after)]


EXPECTED = [*range(20), 20, *range(20, N - 1)]


def written(path: Path, times: Sequence[str], head: str = "time") -> Path:
    rows = [f"{t};{20 + k / 10};{k}" for k, t in enumerate(times)]
    path.write_text("\n".join([f"{head};T [degC];n [rpm]", *rows, ""]), encoding="utf-8")
    return path


def read(path: Path) -> tuple[list[int], list[float], list[Loss]]:
    source = Source(timezone="UTC")
    table = delimited.open_table(path, source)
    items = list(delimited.blocks(path, table, source))
    held = [b for b in items if isinstance(b, Block)]
    t_ns = np.concatenate([b.t_ns for b in held])
    values = np.concatenate([b.values["n [rpm]"] for b in held])
    return t_ns.tolist(), values.tolist(), [x for x in items if isinstance(x, Loss)]


@pytest.mark.parametrize(
    ("times", "head"),
    [
        (stamps(), "time"),
        (stamps(shape="%d.%m.%Y %H:%M:%S"), "time"),
        (stamps("Z", "%Y-%m-%dT%H:%M:%S"), "time"),
        (stamps("+00:00"), "time"),
        (stamps(shape="%Y-%m-%d;%H:%M:%S"), "date;time"),
    ],
)
def test_a_leap_second_is_the_next_day_s_first_second_and_told(tmp_path: Path, times: list[str], head: str) -> None:
    t_ns, values, losses = read(written(tmp_path / "a.csv", times, head))
    start = int(AT.timestamp())
    assert [t // 10**9 - start for t in t_ns] == EXPECTED
    assert values == list(range(N))
    ((told),) = losses
    assert told.where == "a.csv line 22"
    assert "1 time at second 60 is read as the minute after its own" in told.reason
    assert told.from_ns == (start + 20) * 10**9


def test_times_of_day_go_on_over_a_leap_second(tmp_path: Path) -> None:
    t_ns, values, losses = read(written(tmp_path / "a.csv", stamps(shape="%H:%M:%S")))
    assert [t // 10**9 for t in t_ns] == EXPECTED
    assert len(values) == N
    assert len(losses) == 1


def test_seconds_that_were_rounded_up_are_of_the_next_minute(tmp_path: Path) -> None:
    """'%04.1f' of 59.97 is 60.0."""
    moments = [AT + timedelta(seconds=0.07 * k) for k in range(3000)]
    times = [f"{m:%Y-%m-%d %H:%M}:{m.second + m.microsecond / 1e6:04.1f}" for m in moments]
    rounded = sum(":60.0" in t for t in times)
    t_ns, values, losses = read(written(tmp_path / "a.csv", times))
    assert len(values) == 3000
    assert max(abs(t / 1e9 - m.timestamp()) for t, m in zip(t_ns, moments, strict=True)) < 0.06
    ((told),) = losses
    assert rounded > 1
    assert f"{rounded} times at second 60 are read" in told.reason


def test_nothing_is_told_of_sixty_elsewhere(tmp_path: Path) -> None:
    times = [f"2016-12-31 23:0{k // 6}:{k % 6}0.6{k:02}" for k in range(54)]
    assert read(written(tmp_path / "a.csv", times))[2] == []


def test_texts_in_memory_tell_it_as_a_note() -> None:
    found = times_of_texts(stamps(), "UTC", None, "a.parquet")
    assert [int(t) // 10**9 - int(AT.timestamp()) for t in found.t_ns] == EXPECTED
    assert any("second 60" in note for note in found.notes)
    assert not any("second 60" in note for note in times_of_texts(stamps()[:20], "UTC", None, "a.parquet").notes)
