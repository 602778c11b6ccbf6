"""Rows that count from a start above them, through a second start and through nights in which clocks change."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError
from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.file import lines as file_lines

SEVEN = 1772434800 * 10**9  # 2026-03-02 07:00 UTC
NUMBERS = ["Zeit [s];T1 [°C];T2 [°C]", *(f"{60 * i}.0;{20 + i / 10:.1f};2{i % 9}.0" for i in range(40))]
CLOCKS = ["Uhrzeit;T1 [°C];T2 [°C]", *(f"07:{i:02d}:00;{20 + i / 10:.1f};2{i % 9}.0" for i in range(40))]
ELAPSED = ["Time;T1 [°C];T2 [°C]", *(f"00:{i:02d}:00;{20 + i / 10:.1f};2{i % 9}.0" for i in range(40))]
AGAIN = [NUMBERS[0], *(f"{60 * i}.0;30.{i % 9};31.0" for i in range(20))]


def read(
    folder: Path, head: list[str], rows: list[str], zone: str | None = None
) -> tuple[str, int, tuple[str, ...], list[int]]:
    """(clock, start, notes, minutes of the rows since the first)"""
    path = folder / "log.csv"
    path.write_text("\n".join([*head, "", *rows, ""]), "utf-8")
    source = Source(timezone=zone)
    table = delimited.open_table(path, source)
    said = delimited.describe(table, source)
    times = np.concatenate([b.t_ns for b in delimited.blocks(path, table, source) if isinstance(b, Block)])
    return said.clock, int(times[0]), said.notes, ((times - times[0]) // (60 * 10**9)).tolist()


@pytest.mark.parametrize("again", ["Messbeginn: Mo, 02.03.2026 08:00 Uhr", "Messbeginn;02.03.2026 08:00:00;"])
def test_a_logger_that_was_started_again_counts_from_its_second_start(tmp_path: Path, again: str) -> None:
    rows = [*NUMBERS, "Logger XY", again, *AGAIN]
    clock, start, notes, minutes = read(tmp_path, ["Logger XY", "Messbeginn: 02.03.2026 07:00:00"], rows)
    assert (clock, start, minutes) == ("absolute", SEVEN, [*range(40), *range(60, 80)])
    assert any("count anew from the start in a further head: 'Messbeginn: " in n for n in notes)
    elapsed = [*ELAPSED, again, ELAPSED[0], *ELAPSED[1:21]]
    assert read(tmp_path, ["Messbeginn: 02.03.2026 07:00:00"], elapsed)[3] == [*range(40), *range(60, 80)]


def test_a_start_between_rows_that_count_on_changes_nothing(tmp_path: Path) -> None:
    head, rows = ["Start: 2026-03-02 07:00:00"], [*NUMBERS[:21], "Start: 2026-03-02 09:00:00", *NUMBERS[21:]]
    _, start, notes, minutes = read(tmp_path, head, rows)
    assert (start, minutes) == (SEVEN, list(range(40)))
    assert not any("anew" in n for n in notes)


@pytest.mark.parametrize("footer", ["Test: 02.03.2026 07:40:00", "Recorded: 02.03.2026 09:00:00"])
def test_a_moment_below_the_rows_is_no_further_head(tmp_path: Path, footer: str) -> None:
    _, _, notes, minutes = read(tmp_path, ["Start: 2026-03-02 07:00:00"], [*NUMBERS, footer])
    assert minutes == list(range(40))
    assert not any("anew" in n for n in notes)


@pytest.mark.parametrize("again", [False, True])
def test_a_start_counts_alike_wherever_chunks_are_cut(
    tmp_path: Path, again: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    event = ["Start: 02.03.2026 08:00:00", *AGAIN] if again else ["Trigger: 02.03.2026 07:20:00", *NUMBERS[21:]]
    lines = ["Start: 2026-03-02 07:00:00", "", *NUMBERS[: None if again else 21], *event]
    expected = [*range(40), *range(60, 80)] if again else list(range(40))
    at = "\n".join([*lines, ""]).index(event[0])
    for size in (at - 20, at, at + 5, at + len(event[0]) + 1, at + len(event[0]) + 40, at + 100):
        monkeypatch.setattr(file_lines.chunks, "__defaults__", (size,))
        assert read(tmp_path, lines[:1], lines[2:])[3] == expected, size


@pytest.mark.parametrize(("day", "hour"), [("2026-03-29", 1), ("2026-10-25", 2)])
def test_seconds_from_a_start_skip_and_repeat_no_hour(tmp_path: Path, day: str, hour: int) -> None:
    """A logger that counts does not follow the clock on the wall; times of day may."""
    seconds = [NUMBERS[0], *(f"{60 * i}.0;20.{i % 9};21.0" for i in range(200))]
    head = [f"Start: {day} {hour:02d}:30:00"]
    _, _, notes, minutes = read(tmp_path, head, seconds, zone="Europe/Paris")
    assert minutes == list(range(200))
    assert not any("skips" in n or "daylight saving" in n for n in notes)


def test_times_of_day_that_run_on_where_clocks_change_are_refused(tmp_path: Path) -> None:
    clocks = [CLOCKS[0], *(f"{1 + (30 + i) // 60:02d}:{(30 + i) % 60:02d}:00;2{i % 9}.5;20.0" for i in range(200))]
    with pytest.raises(FormatError, match="run straight on"):
        read(tmp_path, ["Datum: 2026-03-29"], clocks, zone="Europe/Paris")
