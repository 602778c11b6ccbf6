"""Milliseconds that a comma parts from their time, as Python's logging writes them: asked, and read meanwhile."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited


def _read(folder: Path, head: str, rows: list[str], source: Source) -> tuple[list[int], list[str]]:
    (folder / "a.csv").write_text("\n".join([head, *rows, ""]))
    table = delimited.open_table(folder / "a.csv", source)
    blocks = [b for b in delimited.blocks(folder / "a.csv", table, source) if isinstance(b, Block)]
    return [int(t) for b in blocks for t in b.t_ns], sorted({name for b in blocks for name in b.values})


@pytest.mark.parametrize(
    ("head", "day"), [("time,T_bearing,T_bed,dZ", "2026-03-02 "), ("date,time,T_bearing,T_bed,dZ", "2026-03-02,")]
)
def test_a_time_whose_milliseconds_have_no_name_is_asked_and_read(tmp_path: Path, head: str, day: str) -> None:
    rows = [f"{day}08:00:{k:02d},{(250 * k) % 1000:03d},2{k % 9}.9,20.4,-1.9" for k in range(60)]
    with pytest.raises(QuestionError) as asked:
        _read(tmp_path, head, rows, Source())
    assert asked.value.ask.endswith("a time with its milliseconds?")
    times, names = _read(tmp_path, head, rows, Source(table=asked.value.declare))
    first = int(np.datetime64("2026-03-02T08:00", "ns").astype(np.int64))
    assert times == [first + k * 10**9 + (250 * k) % 1000 * 10**6 for k in range(60)]
    assert names == ["T_bearing", "T_bed", "dZ"]


def test_whole_seconds_have_milliseconds_too(tmp_path: Path) -> None:
    rows = [f"2026-03-02 08:00:{k:02d},000,2{k % 9}.9,20.4" for k in range(60)]
    with pytest.raises(QuestionError, match="milliseconds"):
        _read(tmp_path, "time,T_bearing,T_bed", rows, Source())


# the last: a speed of 900 rpm, which stands
@pytest.mark.parametrize("cell", ["{k:02d}", "21.{k:03d}", "1{k:04d}", "900"])
def test_another_cell_without_a_name_is_refused(tmp_path: Path, cell: str) -> None:
    rows = [f"2026-03-02 08:00:{k:02d},{cell.format(k=k)},2{k % 9}.9,20.4" for k in range(60)]
    with pytest.raises(FormatError, match="fewer cells") as told:
        _read(tmp_path, "time,T_bearing,T_bed", rows, Source())
    assert not isinstance(told.value, QuestionError)
