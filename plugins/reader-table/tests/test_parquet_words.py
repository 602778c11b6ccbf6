"""Parquet whose time stands in several columns of words or parts is read, asked and refused as a table of text is."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Source
from thermodata.testing.reader import load

_N = 40
_MINUTES = [8 * 60 + 30 * k for k in range(_N)]  # from 8 in the morning over noon and midnight
_DATES = [f"2026-03-{14 + m // 1440}" for m in _MINUTES]
_OF_24 = [f"{m // 60 % 24:02d}:{m % 60:02d}:00" for m in _MINUTES]
_OF_12 = [f"{(m // 60 - 1) % 12 + 1}:{m % 60:02d}:00" for m in _MINUTES]
_LATE = [m // 60 % 24 >= 12 for m in _MINUTES]
_HALVES = ["PM" if late else "AM" for late in _LATE]
_T_NS = [int(np.datetime64(f"{d}T{c}", "ns").astype(np.int64)) for d, c in zip(_DATES, _OF_24, strict=True)]
_HOUR_NS = 3600 * 10**9
_DAYS = [int(d[-2:]) for d in _DATES]

# columns -> hours from UTC
READ: dict[str, tuple[dict[str, Any], int]] = {
    "date, time, half": ({"Date": _DATES, "Time": _OF_12, "AM/PM": _HALVES}, 0),
    "date, half, time": ({"Date": _DATES, "AM/PM": _HALVES, "Time": _OF_12}, 0),
    "halves in German": ({"Date": _DATES, "Time": _OF_12, "AM/PM": ["nachm." if x else "vorm." for x in _LATE]}, 0),
    "day of Arrow, time, half": ({"Date": pa.array(_DATES).cast(pa.date32()), "Time": _OF_12, "AM/PM": _HALVES}, 0),
    "one cell, half": ({"Date": [f"{d} {c}" for d, c in zip(_DATES, _OF_12, strict=True)], "AM/PM": _HALVES}, 0),
    "categories": ({"Date": pa.array(_DATES).dictionary_encode(), "Time": _OF_12, "AM/PM": _HALVES}, 0),
    "date, time, offset": ({"Date": _DATES, "Time": _OF_24, "Zone": ["+02:00"] * _N}, 2),
    "date, time, UTC": ({"Date": _DATES, "Time": _OF_24, "TZ": ["UTC"] * _N}, 0),
    "numbers of a date": (
        {
            "Year": [2026] * _N,
            "Month": [3.0] * _N,
            "Day": _DAYS,
            "Hour": [m // 60 % 24 for m in _MINUTES],
            "Minute": [m % 60 for m in _MINUTES],
        },
        0,
    ),
    "texts of a date": ({"Year": ["2026"] * _N, "Month": ["3"] * _N, "Day": [*map(str, _DAYS)], "Time": _OF_24}, 0),
}
REFUSED: dict[str, tuple[dict[str, Any], type[FormatError], str]] = {
    "words": (
        {"Date": _DATES, "Time": _OF_12, "AM/PM": ["late" if x else "early" for x in _LATE]},
        FormatError,
        "half",
    ),
    "CST": ({"Date": _DATES, "Time": _OF_24, "Zone": ["CST"] * _N}, QuestionError, "in a zone that is not known"),
}
KEPT: dict[str, dict[str, Any]] = {
    "direction": {"Date": _DATES, "Time": _OF_24, "Tool": ["EST"] * _N},
    "shift": {"Date": _DATES, "Time": _OF_24, "Shift": ["early" if k % 2 else "late" for k in range(_N)]},
}


def _both(folder: Path, columns: dict[str, Any]) -> Iterator[Path]:
    """The same table as Parquet and as text."""
    table = pa.table({**columns, "T_bed": np.arange(float(_N))})
    pq.write_table(table, folder / "a.parquet")
    rows = [";".join(map(str, row.values())) for row in table.to_pylist()]
    (folder / "a.csv").write_text("\n".join([";".join(table.column_names), *rows, ""]))
    yield from (folder / "a.parquet", folder / "a.csv")


@pytest.mark.parametrize(("columns", "ahead"), READ.values(), ids=READ)
def test_a_time_in_several_columns_is_read(tmp_path: Path, columns: dict[str, Any], ahead: int) -> None:
    for path in _both(tmp_path, columns):
        found = load(Reader(), path, Source())
        assert [s.name for s in found.recording.signals] == ["T_bed"]
        assert found.recording.clock == "absolute"
        assert found.t_ns["table"].tolist() == [t - ahead * _HOUR_NS for t in _T_NS]


@pytest.mark.parametrize(("columns", "error", "said"), REFUSED.values(), ids=REFUSED)
def test_a_part_of_the_time_that_is_not_known_is_asked_or_refused(
    tmp_path: Path, columns: dict[str, Any], error: type[FormatError], said: str
) -> None:
    for path in _both(tmp_path, columns):
        with pytest.raises(error, match=said):
            Reader().describe(path, Source())


@pytest.mark.parametrize("columns", KEPT.values(), ids=KEPT)
def test_words_beside_a_time_that_are_no_part_of_it_are_signals(tmp_path: Path, columns: dict[str, Any]) -> None:
    for path in _both(tmp_path, columns):
        found = load(Reader(), path, Source())
        assert len(found.recording.signals) == 2
        assert found.t_ns["table"].tolist() == _T_NS


_UNIX = [1_772_434_800 + 10 * k for k in range(_N)]


@pytest.mark.parametrize(
    ("values", "said", "told"),
    [
        ([float(t) for t in _UNIX], "s", ""),
        ([float(t) for t in _UNIX], "seconds", ""),
        ([1000 * t for t in _UNIX], "ms", ""),
        (_UNIX, "unix timestamp", "no unit of time"),
        (_UNIX, "UTC", "no unit of time"),
        (_UNIX, "1", "no unit of time"),
        (_UNIX, "s since 1970-01-01", ""),
    ],
)
def test_metadata_of_a_time_lose_no_date(tmp_path: Path, values: list[Any], said: str, told: str) -> None:
    """'s' of Unix times is their step, and what is no unit of time is told and left."""
    made = pa.field("time", pa.array(values).type, metadata={"unit": said})
    table = pa.table([pa.array(values), np.arange(float(_N))], schema=pa.schema([made, pa.field("T", pa.float64())]))
    pq.write_table(table, path := tmp_path / "a.parquet")
    recording = Reader().describe(path, Source())
    assert recording.clock == "absolute"
    assert recording.start_ns == _UNIX[0] * 10**9
    assert any(told in n for n in recording.notes) if told else not any("metadata" in n for n in recording.notes)


def test_metadata_tell_the_step_of_a_time_from_a_start(tmp_path: Path) -> None:
    made = pa.field("time", pa.float64(), metadata={"unit": "min"})
    table = pa.table(
        [np.arange(float(_N)), np.arange(float(_N))], schema=pa.schema([made, pa.field("T", pa.float64())])
    )
    pq.write_table(table, path := tmp_path / "a.parquet")
    assert Reader().describe(path, Source()).clock == "relative"
