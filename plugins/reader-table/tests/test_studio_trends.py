"""Trends of Studio 5000, whose times of day have a ';' before their milliseconds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.plugin import Source
from thermodata.reader.text.cells.lines.delimiter import find_delimiter
from thermodata.testing.reader import load
from thermodata.testing.reader.case import head

HEAD = '"Controller Name:","PLC1"\n"Trend Name:","Temperatures"\n"Sample Period:","1000 ms"\n'


@pytest.mark.parametrize("quote", ["", '"'])
@pytest.mark.parametrize("kept", [HEAD + "Header:,Date,Time,T1,T2\n", "Date,Time,T1,T2\n"])
def test_their_milliseconds_are_no_cell(tmp_path: Path, quote: str, kept: str) -> None:
    path = tmp_path / "trend.csv"
    first = ["Data:"] if kept.startswith(HEAD) else []
    rows = [[*first, "3/13/2026", f"08:30:{i:02};{i * 37 % 1000:03}", f"{20 + i / 8}", f"{i}"] for i in range(30)]
    path.write_text(kept + "".join(",".join(f"{quote}{cell}{quote}" for cell in row) + "\n" for row in rows))
    assert Reader().sniff(head(path)) is not None
    data = load(Reader(), path, Source())
    t_ns = np.concatenate(list(data.t_ns.values()))
    assert (t_ns[:2] - np.datetime64("2026-03-13T08:30", "ns").astype(np.int64)).tolist() == [0, 1_037_000_000]
    values = {name: column.tolist() for (_, name), column in data.values.items()}
    assert values["T1"] == [20 + i / 8 for i in range(30)]
    assert not data.losses


def test_a_semicolon_behind_a_time_still_parts_cells() -> None:
    rows = [f"2026-03-13 08:30:{i:02};123,5;20,{i}" for i in range(30)]
    assert find_delimiter(rows) == ";"
    assert find_delimiter([f"08:30:{i:02};123,5" for i in range(30)]) == ";"
