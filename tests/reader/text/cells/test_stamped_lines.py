"""What a terminal that logs a serial line writes before each of its lines."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import QuestionError
from thermodata.plugin import Source
from thermodata.reader.text.cells.lines.stamped_lines import stamped_by, with_stamp
from thermodata.testing.reader import Data, load

NS = 1_000_000_000
STAMPS = [f"2026-05-12 23:59:{k:02d}.500" for k in range(10, 60)] + [f"2026-05-13 00:00:{k:02d}.500" for k in range(30)]
ROWS = [f"{1870 + 1000 * k},{20 + k / 50:.2f},{k / 10:.1f}" for k in range(len(STAMPS))]
HEADER = "millis,T1,dZ"


def log(tmp_path: Path, lines: Sequence[str], **table: object) -> Data:
    (tmp_path / "a.log").write_text("\n".join([*lines, ""]), encoding="utf-8")
    return load(Reader(), tmp_path / "a.log", Source(timezone="UTC", table=table or None))


def _held(data: Data, signal: str) -> list[float]:
    (values,) = [v for (_, name), v in data.values.items() if name == signal]
    return [float(v) for v in values]


def test_the_clock_of_tera_term_is_the_time_below_a_header_and_beside_what_a_board_says(tmp_path: Path) -> None:
    lines = [f"[{s}] {row}" for s, row in zip(STAMPS, ROWS, strict=True)]
    said = [f"[{STAMPS[0]}] rst:0x1 (POWERON_RESET),boot:0x13", f"[{STAMPS[0]}] ", f"[{STAMPS[0]}] {HEADER}"]
    data = log(tmp_path, [*said, *lines[:40], f"[{STAMPS[40]}] # RTD3 fault 0x04", *lines[40:]])
    times = data.t_ns["table"]
    assert times.size == len(STAMPS)
    assert int(times[0]) == int(np.datetime64("2026-05-12T23:59:10.500", "ns").astype(np.int64))
    assert set(np.diff(times).tolist()) == {NS}
    assert _held(data, "T1")[:2] == [20.0, 20.02]
    assert [loss.reason for loss in data.losses] == ["expected 4 cells, got 1: '# RTD3 fault 0x04'"]


@pytest.mark.parametrize("delimiter", [",", ";", "\t", " "])
def test_the_clock_of_an_arduino_is_the_time_of_lines_without_a_header(tmp_path: Path, delimiter: str) -> None:
    data = log(tmp_path, [f"{s[11:]} -> {r.replace(',', delimiter)}" for s, r in zip(STAMPS, ROWS, strict=True)])
    assert set(np.diff(data.t_ns["table"]).tolist()) == {NS}
    assert _held(data, "column 4")[:3] == [0.0, 0.1, 0.2]


def test_a_clock_with_words_is_asked_with_the_format_that_reads_it(tmp_path: Path) -> None:
    lines = [f"[Tue May 12 23:59:{k:02d} 2026] {row}" for k, row in zip(range(10, 60), ROWS, strict=False)]
    with pytest.raises(QuestionError) as asked:
        log(tmp_path, lines)
    assert asked.value.declare["time"] == {"column": 1, "format": "%a %b %d %H:%M:%S %Y"}
    assert set(np.diff(log(tmp_path, lines, **asked.value.declare).t_ns["table"]).tolist()) == {NS}


def test_a_comma_in_the_clock_is_its_fraction() -> None:
    assert with_stamp("[2026-05-12 09:00:00,125] 1,2.5", ",") == "2026-05-12 09:00:00.125,1,2.5"


@pytest.mark.parametrize(
    "line", ["[2026-05-12 09:00:00] spindle started", "[12] 1,2,3", "[9:00:00] [INFO] warm, ready", "T -> 1,2"]
)
def test_words_behind_a_clock_and_numbers_in_brackets_are_no_such_lines(line: str) -> None:
    assert stamped_by([line] * 50) == ""
