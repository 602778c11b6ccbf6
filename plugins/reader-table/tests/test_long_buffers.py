"""A multimeter's buffer (Keithley DAQ6510): a row a reading, which names its channel and its unit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import load

HEAD = "Index,Reading,Unit,Channel,Date,Time,Fractional Seconds"


def buffer(folder: Path) -> Path:
    rows = [
        f"{3 * k + j + 1},{x + k / 100:.6E},{unit},{ch},05/04/2026,09:{k:02d}:00,{j / 5:.6f}"
        for k in range(30)
        for j, (ch, unit, x) in enumerate(((101, "Celsius", 21.5), (102, "Celsius", 21.1), (111, "Volt DC", 1.0)))
    ]
    path = folder / "buffer.csv"
    path.write_text("\n".join([HEAD, *rows, ""]), encoding="utf-8")
    return path


def test_the_refusal_says_how_to_declare_its_series(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="each row names what it measures") as refused:
        Reader().describe(buffer(tmp_path), Source())
    assert "declare table: {series: [Channel]}" in str(refused.value.hint)


def test_declared_so_it_is_read_with_the_parts_of_its_seconds(tmp_path: Path) -> None:
    table = {"series": ["Channel"], "time": {"format": "mdy"}}
    data = load(Reader(), buffer(tmp_path), Source(timezone="UTC", table=table))
    begin = int(np.datetime64("2026-05-04T09:00:00", "ns").astype(np.int64))
    first = {stream: int(t[0]) - begin for stream, t in data.t_ns.items()}
    assert sorted(first.values()) == [0, 200_000_000, 400_000_000]
