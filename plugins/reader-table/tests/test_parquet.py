"""Parquet whose footer says one thing of a column in two places."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from decimal import Decimal
from functools import partial
from pathlib import Path
from typing import Any

import duckdb
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from thermodata_reader_table import Reader
from thermodata_reader_table.parquet.footer_check import _Walk, check_footer

from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Source
from thermodata.testing.reader import load


def _mixed(path: Path) -> None:
    """A file in whose footer one bit is turned, so that a column chunk and the schema are of two types."""
    pq.write_table(pa.table({"t [s]": np.arange(5.0), "n": np.arange(5)}), path)
    data = path.read_bytes()
    begin = len(data) - 8 - int.from_bytes(data[-8:-4], "little")
    for at in range(begin, len(data) - 8):
        for bit in range(1, 4):
            path.write_bytes(data[:at] + bytes((data[at] ^ 1 << bit,)) + data[at + 1 :])
            try:
                file = pq.ParquetFile(path)
                chunk = file.metadata.row_group(0).column(1)
                if file.schema.names == ["t [s]", "n"] and chunk.physical_type != file.schema.column(1).physical_type:
                    return
            except (pa.ArrowException, OSError, ValueError, IndexError):
                continue
    raise AssertionError("no bit does it")


def test_a_chunk_of_another_type_than_its_column_is_refused(tmp_path: Path) -> None:
    _mixed(tmp_path / "x.parquet")
    with pytest.raises(FormatError, match="not a readable Parquet file"):
        Reader().describe(tmp_path / "x.parquet", Source())


def test_several_declared_times_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.parquet"
    pq.write_table(pa.table({"t [s]": np.arange(5.0), "n": np.arange(5)}), path)
    with pytest.raises(UsageError, match="several times"):
        Reader().describe(path, Source(table={"time": [{"column": 1}, {"column": 2}]}))
    assert load(Reader(), path, Source(table={"time": [{"column": 1}]})).t_ns["table"].size == 5


def _with_footer(path: Path, data: bytes, change: tuple[bytes, bytes]) -> None:
    """The file with a piece of its footer replaced, which stands there once."""
    begin = len(data) - 8 - int.from_bytes(data[-8:-4], "little")
    body, footer = data[:begin], data[begin:-8]
    assert footer.count(change[0]) == 1
    footer = footer.replace(*change)
    path.write_bytes(body + footer + len(footer).to_bytes(4, "little") + b"PAR1")


def test_a_histogram_with_a_level_too_few_is_refused_before_arrow_ends_the_process(tmp_path: Path) -> None:
    path = tmp_path / "x.parquet"
    schema = pa.schema([pa.field("t [s]", pa.float64(), nullable=False), pa.field("T", pa.float64())])
    pq.write_table(pa.table({"t [s]": np.arange(5.0), "T": [1.0, None, 2.0, 3.0, None]}, schema=schema), path)
    data = path.read_bytes()
    assert load(Reader(), path, Source()).losses == ()
    check_footer(path, pq.ParquetFile(path).schema)  # a sound file has nothing to say
    # of the column T: an empty list of repetition levels, and how many rows stand at the definition levels 0 and 1
    _with_footer(path, data, (b"\x29\x06\x19\x26\x04\x06", b"\x29\x06\x19\x16\x04"))
    with pytest.raises(FormatError, match="not a readable Parquet file") as error:
        Reader().describe(path, Source())
    assert error.value.got == "column 1 counts 1 definition levels, its schema has 2"


def test_a_list_that_lies_about_its_items_is_refused_before_arrow_reads_them_its_own_way(tmp_path: Path) -> None:
    """Arrow reads four counts where the list says four doubles of 32 bytes, so a walk that believes it is lost."""
    path = tmp_path / "x.parquet"
    schema = pa.schema([pa.field("t [s]", pa.float64(), nullable=False), pa.field("T", pa.float64())])
    pq.write_table(pa.table({"t [s]": np.arange(5.0), "T": [1.0, None, 2.0, 3.0, None]}, schema=schema), path)
    _with_footer(path, path.read_bytes(), (b"\x29\x06\x19\x26\x04\x06", b"\x29\x47\x19\x26\x04\x06"))
    with pytest.raises(FormatError, match="not a readable Parquet file") as error:
        Reader().describe(path, Source())
    assert error.value.got == "the list in field 4.1.3.16.2 of its footer has items of type 7"


def _of_arrow(path: Path, **options: Any) -> None:
    n = 50
    table = pa.table(
        {
            "t [s]": np.arange(float(n)),
            "T": [None, 1.5] * (n // 2),
            "word": pa.array(["a", "b"] * (n // 2)).dictionary_encode(),
            "point": pa.array([{"x": 1.0, "inner": {"y": None}}] * n),
            "list": pa.array([[1, 2], None] * (n // 2)),
            "map": pa.array([[("k", 1)]] * n, pa.map_(pa.string(), pa.int64())),
            "sum": pa.array([Decimal("1.25")] * n),
        }
    )
    pq.write_table(table.replace_schema_metadata({"rig": "X" * 300}), path, row_group_size=20, **options)


def _of_duckdb(path: Path) -> None:
    duckdb.sql(
        "copy (select i::double as \"t [s]\", i % 3 as n, [i, i] as l, {x: i} as s, 'w' || i as word "
        f"from range(50) r(i)) to '{path}' (format parquet, row_group_size 20, kv_metadata {{rig: 'X'}})"
    )


@pytest.mark.parametrize(
    "write",
    [
        _of_arrow,
        partial(_of_arrow, write_page_index=True, write_page_checksum=True, data_page_version="2.0"),
        partial(_of_arrow, sorting_columns=[pq.SortingColumn(0)], store_schema=False, version="1.0"),
        partial(_of_arrow, compression="none", use_dictionary=False, write_statistics=False),
        _of_duckdb,
    ],
)
def test_a_footer_of_any_writer_is_walked_through(tmp_path: Path, write: Callable[[Path], None]) -> None:
    path = tmp_path / "x.parquet"
    write(path)
    check_footer(path, pq.ParquetFile(path).schema)
    assert load(Reader(), path, Source()).t_ns["table"].size == 50


def test_a_page_is_held_against_its_checksum(tmp_path: Path) -> None:
    path = tmp_path / "x.parquet"
    table = pa.table({"t [s]": np.arange(50.0), "T": np.arange(50.0) + 20})
    pq.write_table(table, path, compression="none", use_dictionary=False, write_page_checksum=True)
    data = path.read_bytes()
    assert load(Reader(), path, Source()).values["table", "T"][30] == 50.0
    at = data.index(np.float64(50.0).tobytes(), data.index(np.float64(69.0).tobytes()) - 30 * 8)
    path.write_bytes(data[:at] + np.float64(51.0).tobytes() + data[at + 8 :])
    with pytest.raises(FormatError, match="not a readable Parquet file") as error:
        list(Reader().blocks(path, Source()))
    assert "CRC" in str(error.value.got)


def test_a_footer_of_any_bytes_is_walked_through_or_left(tmp_path: Path) -> None:
    path = tmp_path / "x.parquet"
    pq.write_table(pa.table({"t [s]": np.arange(5.0), "n": ["a", "b", None, "c", "d"]}), path)
    data, schema = path.read_bytes(), pq.ParquetFile(path).schema
    begin = len(data) - 8 - int.from_bytes(data[-8:-4], "little")
    rng = np.random.default_rng(0)
    for _ in range(2000):
        at, value = int(rng.integers(begin, len(data) - 8)), int(rng.integers(256))
        path.write_bytes(data[:at] + bytes((value,)) + data[at + 1 :])
        with suppress(ValueError):  # what it says of a damaged file; anything else is a fault of ours
            check_footer(path, schema)


def test_a_map_of_truth_values_hides_nothing_that_stands_behind_it(tmp_path: Path) -> None:
    """Arrow takes a byte for each of them in a map, though a field of a struct has its value in the head."""
    path = tmp_path / "x.parquet"
    schema = pa.schema([pa.field("t [s]", pa.float64(), nullable=False), pa.field("T", pa.float64())])
    pq.write_table(pa.table({"t [s]": np.arange(5.0), "T": [1.0, None, 2.0, 3.0, None]}, schema=schema), path)
    data, known = path.read_bytes(), pq.ParquetFile(path).schema
    begin = len(data) - 8 - int.from_bytes(data[-8:-4], "little")
    assert data[begin] == 0x15  # the first field is an integer: the version
    # a field 100 that is a map of one false to another, and then the field 1 again
    hidden = data[:begin] + b"\x0b\xc8\x01\x01\x11\x00\x00\x05\x02" + data[begin + 1 : -8]
    path.write_bytes(hidden + (len(hidden) - begin).to_bytes(4, "little") + b"PAR1")
    assert pq.ParquetFile(path).metadata.num_rows == 5, "Arrow walks past the map"
    _with_footer(path, path.read_bytes(), (b"\x29\x06\x19\x26\x04\x06", b"\x29\x06\x19\x16\x04"))
    with pytest.raises(ValueError, match="column 1 counts 1 definition levels"):
        check_footer(path, known)


def test_no_footer_takes_more_steps_than_it_has_bytes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Maps that say of themselves that they are long, with no bytes behind."""
    maps = b"\xff\x7f\x11" * 33_000  # 16383 pairs of truth values each
    footer = b"\x19\xfb\xe8\x81\x02" + maps  # a list of 33000 maps
    path = tmp_path / "x.parquet"
    path.write_bytes(b"PAR1" + footer + len(footer).to_bytes(4, "little") + b"PAR1")
    taken = [0]

    def counted(method: Callable[..., None]) -> Callable[..., None]:
        def call(*args: object) -> None:
            taken[0] += 1
            assert taken[0] <= 2 * len(footer)
            method(*args)

        return call

    for name in ("_value", "_past"):
        monkeypatch.setattr(_Walk, name, counted(getattr(_Walk, name)))
    with pytest.raises(ValueError, match="ends within a field"):
        check_footer(path, ())
    assert taken[0] > 1000


def _long(path: Path, *, melted: bool, names: tuple[str, str] = ("name", "value")) -> Path:
    stamps = np.datetime64("2026-03-02T07:00", "ns") + np.arange(2000) * np.timedelta64(60, "s")
    tags = np.array(["T_bearing", "speed"])
    order = np.repeat(tags, 2000) if melted else np.tile(tags, 2000)
    t = np.tile(stamps, 2) if melted else np.repeat(stamps, 2)
    pq.write_table(pa.table({"time": t, names[0]: order, names[1]: np.arange(4000.0)}), path)
    return path


@pytest.mark.parametrize("melted", [True, False])
@pytest.mark.parametrize("names", [("name", "value"), ("tag", "reads")])
def test_a_long_table_is_taken_apart(tmp_path: Path, melted: bool, names: tuple[str, str]) -> None:
    path = _long(tmp_path / "a.parquet", melted=melted, names=names)
    found = [s.name for s in Reader().describe(path, Source()).signals]
    if melted and names[1] == "reads":  # nothing in its first rows says that it is one
        assert found == ["tag", "reads"]
    else:
        assert found == [f"T_bearing/{names[1]}", f"speed/{names[1]}"]


def test_a_table_with_a_label_is_none(tmp_path: Path) -> None:
    t = np.datetime64("2026-03-02T07:00", "ns") + np.arange(90) * np.timedelta64(60, "s")
    program = np.repeat(["O1001", "O1002", "O1003"], 30)
    pq.write_table(pa.table({"time": t, "program": program, "value": np.arange(90.0)}), tmp_path / "a.parquet")
    assert [s.name for s in Reader().describe(tmp_path / "a.parquet", Source()).signals] == ["program", "value"]


def test_names_may_hold_dots_beside_structs_that_are_taken_apart(tmp_path: Path) -> None:
    path = tmp_path / "x.parquet"
    table = {
        "t [s]": np.arange(5.0),
        "Temp": np.arange(5.0) + 10,
        "Temp. Motor [degC]": np.arange(5.0) + 20,
        "Temp.a": np.arange(5.0) + 30,
        "hall": pa.array([{"top.left": float(i), "b": 2.0 * i} for i in range(5)]),
    }
    pq.write_table(pa.table(table), path)
    values = {name: v for (_, name), v in load(Reader(), path, Source()).values.items()}
    assert set(values) == {"Temp", "Temp. Motor [degC]", "Temp.a", "hall/top.left", "hall/b"}
    for name, first in (("Temp", 10.0), ("Temp. Motor [degC]", 20.0), ("Temp.a", 30.0), ("hall/top.left", 0.0)):
        assert values[name].tolist() == [first + i for i in range(5)]


def test_the_file_is_closed_though_something_still_refers_to_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A thread of Arrow may do so for a while: left to Python, Windows would not let the user rename the file."""
    path, opened = tmp_path / "a.parquet", list[pq.ParquetFile]()
    pq.write_table(pa.table({"t [s]": np.arange(5.0), "T1 [degC]": np.arange(5.0)}), path)

    class Remembered(pq.ParquetFile):  # type: ignore[misc]
        def __init__(self, *args: Any, **kwargs: Any) -> None:
            super().__init__(*args, **kwargs)
            opened.append(self)

    monkeypatch.setattr(pq, "ParquetFile", Remembered)
    reader = Reader()
    reader.describe(path, Source())
    items = reader.blocks(path, Source())
    next(items)
    items.close()
    assert reader.locate(path, Source(), "table", 3) is not None
    with pytest.raises(UsageError):
        reader.describe(path, Source(table={"time": {"column": "missing"}}))
    assert len(opened) >= 4
    assert all(file.closed for file in opened)
