"""One table, written in many ways, is one table: whoever claims the file, its times, values, dtypes, units, flags and
losses are the same, and each row knows its line."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermodata.plugin import Source
from thermodata.reader import reader as named
from thermodata.reader import sniff
from thermodata.schema.flag import Flag
from thermodata.testing.reader import Data, load

PRAGUE = Source(timezone="Europe/Prague")
ROWS = 40
START = np.datetime64("2026-03-27T06:00:00", "s")  # in UTC; a day above 12, and before the clocks change
LOCAL = [START + np.timedelta64(3600 + 10 * i, "s") for i in range(ROWS)]
BIG = 9_007_199_254_740_993  # 2**53 + 1


@dataclass(frozen=True)
class Column:
    """cells: as written with a decimal point; values: what they mean; unit: in the header."""

    name: str
    unit: str | None
    dtype: str
    cells: list[str]
    values: list[Any]


def _numbers() -> Column:
    cells = [f"{20 + i / 8:.3f}" for i in range(ROWS)]
    values = [20 + i / 8 for i in range(ROWS)]
    for at, word in ((3, "---"), (5, ""), (7, "#N/A"), (9, "UNAVAILABLE"), (11, "n/a"), (13, "NaN")):
        cells[at], values[at] = word, np.nan
    cells[15], values[15] = "OL", np.nan
    cells[17], values[17] = "ERR", np.nan
    cells[19], values[19] = "1.5e2", 150.0
    cells[21], values[21] = "+   7.25", 7.25
    cells[23], values[23] = "1e999", np.nan
    return Column("T1", "°C", "float64", cells, values)


COLUMNS = [
    _numbers(),
    Column("count", None, "int64", [str(BIG + i) for i in range(ROWS)], [BIG + i for i in range(ROWS)]),
    Column("n", "1/min", "float64", [str(1000 + i) for i in range(ROWS)], [1000.0 + i for i in range(ROWS)]),
    Column(
        "door", None, "bool", ["TRUE" if i % 3 else "FALSE" for i in range(ROWS)], [bool(i % 3) for i in range(ROWS)]
    ),
    Column("program", None, "str", [f"MPF {i // 4}" for i in range(ROWS)], [f"MPF {i // 4}" for i in range(ROWS)]),
]
ODD_LINES = (19, 25)  # of the cells that are no numbers: two rows of header stand above the first row


def _two(moment: np.datetime64, form: str) -> str:
    return moment.astype("datetime64[s]").item().strftime(form)


STYLES: dict[str, Callable[[np.datetime64], str]] = {
    "iso": lambda t: _two(t, "%Y-%m-%d %H:%M:%S"),
    "iso with T": lambda t: _two(t, "%Y-%m-%dT%H:%M:%S"),
    "utc": lambda t: _two(t - np.timedelta64(1, "h"), "%Y-%m-%d %H:%M:%S UTC"),
    "Z": lambda t: _two(t - np.timedelta64(1, "h"), "%Y-%m-%dT%H:%M:%SZ"),
    "offset": lambda t: _two(t, "%Y-%m-%dT%H:%M:%S+01:00"),
    "offset without colon": lambda t: _two(t, "%Y-%m-%d %H:%M:%S +0100"),
    "dots": lambda t: _two(t, "%d.%m.%Y %H:%M:%S"),
    "two digits": lambda t: _two(t, "%d.%m.%y %H:%M:%S"),
    "slashes, day first": lambda t: _two(t, "%d/%m/%Y %H:%M:%S"),
    "slashes, month first": lambda t: _two(t, "%m/%d/%Y %H:%M:%S"),
    "12 hours": lambda t: _two(t, "%m/%d/%Y %I:%M:%S %p"),
    "year first, slashes": lambda t: _two(t, "%Y/%m/%d %H:%M:%S"),
    "milliseconds": lambda t: _two(t, "%Y-%m-%d %H:%M:%S") + ".000",
}
ENCODINGS = ("utf-8", "utf-8-sig", "utf-16", "cp1250", "cp1252")


def write(
    path: Path,
    *,
    delimiter: str = ";",
    decimal: str = ".",
    style: str = "iso",
    encoding: str = "utf-8",
    end: str = "\n",
    units_row: bool = True,
    quoted: bool = False,
    columns: Iterable[Column] = COLUMNS,
) -> Path:
    """The table in one way of many; what holds the delimiter is quoted."""

    def line(cells: Iterable[str]) -> str:
        made = []
        for cell in cells:
            made.append(f'"{cell}"' if quoted or delimiter in cell else cell)
        return delimiter.join(made)

    columns = list(columns)
    if units_row:
        lines = [line(["Time", *(c.name for c in columns)]), line(["", *(c.unit or "" for c in columns)])]
    else:
        lines = [line(["Time", *(f"{c.name} [{c.unit}]" if c.unit else c.name for c in columns)]), ""]
    for i in range(ROWS):
        cells = [c.cells[i].replace(".", decimal) if c.dtype == "float64" else c.cells[i] for c in columns]
        lines.append(line([STYLES[style](LOCAL[i]), *cells]))
    path.write_bytes("".join(text + end for text in lines).encode(encoding))
    return path


def read(path: Path, source: Source = PRAGUE) -> Data:
    return load(sniff(path), path, source)


def check(data: Data) -> None:
    (stream,) = data.t_ns
    np.testing.assert_array_equal(
        data.t_ns[stream], (START + 10 * np.arange(ROWS)).astype("datetime64[ns]").astype(int)
    )
    assert data.recording.clock == "absolute"
    assert data.recording.start_ns == data.t_ns[stream][0]
    signals = {s.name.split(" [")[0]: s for s in data.recording.signals}
    for column in COLUMNS:
        signal = signals[column.name]
        assert (signal.unit, signal.dtype) == (column.unit, column.dtype), column.name
        values = data.values[stream, signal.name]
        if column.dtype == "float64":
            np.testing.assert_array_equal(values, column.values)
        else:
            assert values.tolist() == column.values
    flags = data.flags[stream, signals["T1"].name]
    assert np.flatnonzero(flags).tolist() == [15]
    assert flags[15] == Flag.SATURATED
    told = [(loss.where.split(" column")[0].rsplit("line ", 1)[1], loss.from_ns, loss.to_ns) for loss in data.losses]
    rows = data.t_ns[stream]
    assert told == [(str(n + 1), int(rows[n - 2]), int(rows[n - 2])) for n in ODD_LINES]
    assert [loss.reason.replace(",", ".") for loss in data.losses] == [
        "expected a number. got 'ERR'",
        "expected a number. got '1e999'",
    ]


@pytest.mark.parametrize("delimiter", [";", "\t", ",", "|"])
@pytest.mark.parametrize("style", STYLES)
def test_dates_between_any_delimiter(tmp_path: Path, delimiter: str, style: str) -> None:
    if delimiter == "|":  # claimed by nobody: too many files that are no tables hold bars
        path = write(tmp_path / "x.csv", delimiter=delimiter, style=style)
        check(load(named("table"), path, PRAGUE))
        return
    check(read(write(tmp_path / "x.csv", delimiter=delimiter, style=style)))


@pytest.mark.parametrize("delimiter", [";", "\t", ","])
@pytest.mark.parametrize("decimal", [".", ","])
@pytest.mark.parametrize("encoding", ENCODINGS)
def test_encodings_and_decimal_marks(tmp_path: Path, delimiter: str, decimal: str, encoding: str) -> None:
    check(read(write(tmp_path / "x.csv", delimiter=delimiter, decimal=decimal, encoding=encoding)))


@pytest.mark.parametrize("delimiter", [";", "\t", ","])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("quoted", [False, True])
@pytest.mark.parametrize("units_row", [False, True])
def test_line_ends_quotes_and_units(tmp_path: Path, delimiter: str, end: str, quoted: bool, units_row: bool) -> None:
    check(read(write(tmp_path / "x.csv", delimiter=delimiter, end=end, quoted=quoted, units_row=units_row)))


@pytest.mark.parametrize("delimiter", [";", "\t", ","])
def test_each_row_knows_its_line(tmp_path: Path, delimiter: str) -> None:
    path = write(tmp_path / "x.csv", delimiter=delimiter)
    lines = path.read_text().splitlines()
    reader = sniff(path)
    (stream,) = read(path).t_ns
    for row in (0, 17, ROWS - 1):
        where = reader.locate(path, PRAGUE, stream, row)  # type: ignore[attr-defined]
        assert lines[int(where.removeprefix("line ")) - 1].split(delimiter)[3] == str(1000 + row)


@pytest.mark.parametrize("delimiter", [";", "\t", ","])
def test_times_of_day_with_a_zone_or_without(tmp_path: Path, delimiter: str) -> None:
    """`08:00:00 UTC` was claimed by nobody, or read with its zone lost."""
    for zone in ("", " UTC", "Z", "+01:00"):
        path = tmp_path / "x.csv"
        rows = [f"{(23 * 60 + 50 + i) // 60 % 24:02d}:{(50 + i) % 60:02d}:00{zone}" for i in range(20)]
        path.write_text(f"clock{delimiter}T\n" + "".join(f"{t}{delimiter}{i}.5\n" for i, t in enumerate(rows)))
        data = read(path)
        assert data.recording.clock == "relative"
        (t_ns,) = data.t_ns.values()
        np.testing.assert_array_equal(t_ns, np.arange(20) * 60 * 10**9)  # over midnight
        assert not data.losses


@pytest.mark.parametrize("delimiter", [";", "\t", ","])
def test_numbers_that_a_float_would_round_are_exact_or_lost(tmp_path: Path, delimiter: str) -> None:
    path = tmp_path / "x.csv"
    rows = "".join(f"2026-03-27 06:00:{i:02d}{delimiter}{i}.5{delimiter}1\n" for i in range(30))
    path.write_text(f"Time{delimiter}a{delimiter}b\n{rows}2026-03-27 06:01:00{delimiter}{BIG}{delimiter}1\n")
    data = read(path)
    values = next(v for (_, name), v in data.values.items() if name == "a")
    assert np.isnan(values[-1])
    assert [x.reason for x in data.losses] == [f"an integer that float64 would round, got '{BIG}'"]


@pytest.mark.parametrize("delimiter", [";", "\t", ","])
@pytest.mark.parametrize(("written", "year"), [("25.12.85", 1985), ("25.12.69", 1969), ("25.12.68", 2068)])
def test_years_of_two_digits_have_one_window(tmp_path: Path, delimiter: str, written: str, year: int) -> None:
    path = tmp_path / "x.csv"
    path.write_text(f"Time{delimiter}a\n" + "".join(f"{written} 08:00:{i:02d}{delimiter}{i}.5\n" for i in range(9)))
    (t_ns,) = read(path, Source(timezone="UTC")).t_ns.values()
    assert np.datetime64(int(t_ns[0]), "ns").astype("datetime64[D]") == np.datetime64(f"{year}-12-25")


@pytest.mark.parametrize("delimiter", [";", "\t", ","])
def test_a_damaged_row_near_the_top_is_lost_and_does_not_make_names_of_the_first(
    tmp_path: Path, delimiter: str
) -> None:
    path = write(tmp_path / "x.csv", delimiter=delimiter)
    lines = path.read_text().splitlines()
    lines[3] = lines[3].replace(delimiter, "", 1)
    path.write_text("\n".join(lines) + "\n")
    data = read(path)
    assert [s.name for s in data.recording.signals] == [c.name for c in COLUMNS]
    (t_ns,) = data.t_ns.values()
    assert t_ns.size == ROWS - 1
    assert data.losses[0].where == "x.csv line 4"
    lines[3] = "Summe" + 4 * delimiter
    path.write_text("\n".join(lines) + "\n")
    data = read(path)
    assert [s.name for s in data.recording.signals] == [c.name for c in COLUMNS]
    assert any(loss.where == "x.csv line 4" for loss in data.losses)


@pytest.mark.parametrize("delimiter", [";", "\t", ","])
def test_bytes_of_zero_before_a_row_cost_nothing_of_it_and_inside_a_number_the_number(
    tmp_path: Path, delimiter: str
) -> None:
    path = write(tmp_path / "x.csv", delimiter=delimiter)
    lines = path.read_text().splitlines()
    lines[10] = "\0" * 512 + lines[10]
    cells = lines[20].split(delimiter)
    cells[1] = cells[1][:2] + "\0" * 16 + cells[1][2:]
    lines[20] = delimiter.join(cells)
    path.write_text("\n".join(lines) + "\n")
    data = load(named("table"), path, PRAGUE)  # in its first 4 KiB they would be taken for binary data
    (t_ns,) = data.t_ns.values()
    assert t_ns.size == ROWS
    values = next(v for (_, name), v in data.values.items() if name == "T1")
    assert values[8] == COLUMNS[0].values[8]
    assert np.isnan(values[18])
    told = {loss.where.split(" column")[0]: loss.reason for loss in data.losses}
    assert told["x.csv line 11"] == "512 NUL bytes: what was written here is lost"
    assert "x.csv line 21" in told


@pytest.mark.parametrize("delimiter", [";", "\t", ","])
def test_a_delimiter_too_much_loses_its_row_and_shifts_nothing(tmp_path: Path, delimiter: str) -> None:
    """In a file whose rows end with a delimiter, a doubled one leaves an empty cell behind the last column."""
    path = tmp_path / "x.csv"
    rows = [f"2026-03-27 06:00:{i:02d}{delimiter}{i}.5{delimiter}{100 + i}{delimiter}" for i in range(30)]
    rows[12] = rows[12].replace(delimiter, 2 * delimiter, 1)
    path.write_text(delimiter.join(["Time", "a", "b", ""]) + "\n" + "\n".join(rows) + "\n")
    data = read(path)
    assert [loss.where for loss in data.losses] == ["x.csv line 14"]
    for (_, name), values in data.values.items():
        expected = [i + 0.5 if name == "a" else 100.0 + i for i in range(30) if i != 12]
        np.testing.assert_array_equal(values, expected)


@pytest.mark.parametrize("delimiter", [";", "\t", ","])
@pytest.mark.parametrize("cells", [-1, 90])
def test_one_torn_row_does_not_take_the_milliseconds_from_the_time(tmp_path: Path, delimiter: str, cells: int) -> None:
    path = tmp_path / "x.csv"
    rows = [delimiter.join((f"2026-03-27 06:00:{i:02d}", str(i * 7), f"{i}.5")) for i in range(40)]
    rows[8] = rows[8].replace(f"{delimiter}8.5", "8.5") if cells < 0 else rows[8][:19] + cells * delimiter
    path.write_text(delimiter.join(("Time", "ms", "a")) + "\n" + "\n".join(rows) + "\n")
    data = read(path)
    assert [s.name for s in data.recording.signals] == ["a"]
    (t_ns,) = data.t_ns.values()
    np.testing.assert_array_equal(t_ns % 10**9, [i * 7_000_000 for i in range(40) if i != 8])


@pytest.mark.parametrize("delimiter", [";", "\t", ","])
def test_a_torn_first_row_is_a_loss_and_no_header(tmp_path: Path, delimiter: str) -> None:
    path = tmp_path / "x.csv"
    rows = [delimiter.join((f"2026-03-27T06:00:{i:02d}Z", str(i * 7), f"{i}e-3", "TRUE")) for i in range(30)]
    rows[0] = rows[0].replace(delimiter, "", 1)
    path.write_text(delimiter.join(("time", "ms", "a", "ok")) + "\n" + "\n".join(rows) + "\n")
    data = read(path)
    assert [(s.name, s.dtype) for s in data.recording.signals] == [("a", "float64"), ("ok", "bool")]
    assert [loss.where for loss in data.losses] == ["x.csv line 2"]
