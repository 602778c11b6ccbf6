"""Rows that a keyword calls signals or units, before the name of the time: text of Hioki's memory recorders."""

from __future__ import annotations

from pathlib import Path

import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

HEAD = """\
"COMMENT","8826 MEM DATA"
"NUM_SIGS", 6
"INTERVAL", 1.000E+01
"HORZ_UNITS", "s"
"VERT_UNITS", "s", "um", "um", "um", "C", "rpm"
"SIGNAL","TIME", "ACH 1", "ACH 2", "ACH 3", "ACH 4", "ACH 5"
"DATA"
"""
ROWS = "".join(f"{10 * k:+.6E}, {k / 10:+.4E}, -1.0E-02, 2.0E-02, {20 + k / 100:+.4E}, 0.0E+00\n" for k in range(40))


def read(tmp_path: Path, text: str, **table: object) -> Data:
    (tmp_path / "a.txt").write_text(text)
    return load(Reader(), tmp_path / "a.txt", Source(table=table))


@pytest.mark.parametrize("table", [{}, {"header_rows": 6}, {"header_rows": 7}])
def test_a_keyword_before_the_time_calls_the_row(tmp_path: Path, table: dict[str, object]) -> None:
    data = read(tmp_path, HEAD + ROWS, **table)
    assert [(s.name, s.unit) for s in data.recording.signals] == [
        *((f"ACH {k}", "um") for k in (1, 2, 3)),
        ("ACH 4", "C"),
        ("ACH 5", "rpm"),
    ]
    assert [v[-1] for v in data.values.values()] == [3.9, -0.01, 0.02, 20.39, 0.0]
    assert int(data.t_ns["table"][1]) == 10**10


def test_rows_of_the_header_are_offered_only_where_names_stand_over_their_columns(tmp_path: Path) -> None:
    rows = "".join(f"{10 * k},{k % 3},{20 + k / 100}\n" for k in range(40))
    with pytest.raises(FormatError, match="more cells") as apart:
        read(tmp_path, f"no,TIME [s],A,B,C\n{rows}")
    assert "header_rows: 1}" not in (apart.value.hint or "")
    with pytest.raises(FormatError, match="more cells") as over:
        read(tmp_path, f"TIME [s],A,B,C,D\n{rows}")
    assert "header_rows: 1}" in (over.value.hint or "")
