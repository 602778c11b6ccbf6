"""Units that stand in a column of a table whose rows are of several sensors: each series has its own, and what comes in
another one is converted, lost, or left as it stands, and told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from thermodata_reader_table import Reader

from thermodata.testing.reader import load

from .test_series import UTC, N, read, stamp, values
from .test_sheets import sheet, workbook


def test_a_unit_in_each_row_is_that_of_its_series(tmp_path: Path) -> None:
    units = ("degC", "um")
    rows = [f"{stamp(10 * k)},{('T1', 'dX')[d]},{20 + d + k / 8},{units[d]}" for k in range(N) for d in (0, 1)]
    data = read(tmp_path / "a.csv", "when,what,how much,unit", rows)
    assert {s.name: s.unit for s in data.recording.signals if s.dtype != "str"} == {
        "T1/how much": "degC",
        "dX/how much": "um",
    }
    assert not data.losses


@pytest.mark.parametrize("kind", ["csv", "parquet", "xlsx"])
@pytest.mark.parametrize("named", [True, False])
def test_a_unit_that_changes_from_row_to_row_is_one(tmp_path: Path, kind: str, named: bool) -> None:
    """A recorder that was set to Fahrenheit halfway, and says it in each row."""
    rows = [
        [stamp(10 * k), *(["T1"] if d == 0 else ["dX"])[: int(named)], *own]
        for k in range(N)
        for d, own in enumerate(
            [
                [20 + k / 8, "degC"] if k < N // 2 + 10 else [(20 + k / 8) * 1.8 + 32, "degF"],
                [30 + k, "um"],  # whole numbers
            ][: 1 + int(named)]
        )
    ]
    header = ["when", *["what"][: int(named)], "how much", "unit"]
    data = load(Reader(), _as(tmp_path, kind, header, rows), UTC)
    name = "T1/how much" if named else "how much"
    assert {s.name: s.unit for s in data.recording.signals}[name] == "degC"
    np.testing.assert_allclose(values(data)[name], [20 + k / 8 for k in range(N)])
    assert not data.losses
    assert any(f"unit of '{name}' row by row: 'degF' is converted to 'degC'" in n for n in data.recording.notes)
    if named:
        assert values(data)["dX/how much"] == [30 + k for k in range(N)]


@pytest.mark.parametrize("kind", ["csv", "parquet", "xlsx"])
def test_a_column_of_whole_numbers_is_converted_in_the_series_that_changes_its_unit_alone(
    tmp_path: Path, kind: str
) -> None:
    rows = [
        [stamp(10 * k), *own]
        for k in range(N)
        for own in (["A", *((20, "degC") if k < N // 2 + 10 else (68, "degF"))], ["B", k, "um"])
    ]
    data = load(Reader(), _as(tmp_path, kind, ["when", "what", "val", "unit"], rows), UTC)
    assert {s.name: s.unit for s in data.recording.signals if s.name.endswith("val")} == {
        "A/val": "degC",
        "B/val": "um",
    }
    np.testing.assert_allclose(values(data)["A/val"], [20.0] * N)
    assert values(data)["B/val"] == list(range(N))
    assert not data.losses


@pytest.mark.parametrize(
    ("a", "b", "told"),
    [
        (("20,degC", "68,degF"), ("3,um", "3,um"), ["'A/unit' says the unit of 'A/val' row by row: 'degF' is conv"]),
        (("20,degC", "20,degC"), ("3,bar", "3,bar"), []),
        (("20,degC", "20,degC"), ("68,degF", "68,degF"), []),  # each keeps its own
    ],
)
def test_of_units_that_the_series_take_nothing_is_told_of_the_whole_column(
    tmp_path: Path, a: tuple[str, str], b: tuple[str, str], told: list[str]
) -> None:
    rows = [f"{stamp(10 * k)},{name},{own[k > 40]}" for k in range(N) for name, own in (("A", a), ("B", b))]
    notes = read(tmp_path / "a.csv", "when,what,val,unit", rows).recording.notes
    said = [n for n in notes if "unit" in n]
    assert len(said) == len(told)
    assert all(n.startswith(t) for n, t in zip(said, told, strict=True))


def test_units_of_several_numbers_are_told_of_series_too(tmp_path: Path) -> None:
    units = ("degC", "bar")
    rows = [f"{stamp(10 * k)},S{d},{20 + k / 8},{3 + k / 9},{units[d]}" for k in range(N) for d in (0, 1)]
    notes = read(tmp_path / "a.csv", "when,what,one,two,unit", rows).recording.notes
    assert any("'unit' says several units (degC, bar), which are not converted" in n for n in notes)


@pytest.mark.parametrize("kind", ["csv", "parquet", "xlsx"])
@pytest.mark.parametrize("named", [True, False])
def test_rows_in_a_unit_of_another_kind_are_lost_and_no_others(tmp_path: Path, kind: str, named: bool) -> None:
    rows = [
        [stamp(10 * k), *([("T1", "dX")[d]] if named else []), 20.5 + d, "bar" if d == 0 and 40 <= k < 43 else "degC"]
        for k in range(N)
        for d in range(1 + int(named))
    ]
    header = ["when", *["what"][: int(named)], "how much", "unit"]
    data = load(Reader(), _as(tmp_path, kind, header, rows), UTC)
    found = values(data)
    if named:
        assert found["T1/how much"] == [20.5] * (N - 3)
        assert found["dX/how much"] == [21.5] * N
        assert [loss.reason.partition(";")[0] for loss in data.losses] == [
            "3 rows of 'T1' in another unit than 'degC': bar, not read"
        ]
    else:  # nothing says which of them is meant
        assert any("'unit' says several units (degC, bar), which are not converted" in n for n in data.recording.notes)


@pytest.mark.parametrize("kind", ["csv", "parquet", "xlsx"])
@pytest.mark.parametrize("words", [["degC"] * N, ["A", "B"] * (N // 2), ["ok"] * N])
def test_a_column_of_one_unit_or_of_none_asks_and_tells_nothing(tmp_path: Path, kind: str, words: list[str]) -> None:
    rows = [[stamp(10 * k), 20.5 + k, words[k]] for k in range(N)]
    data = load(Reader(), _as(tmp_path, kind, ["time", "T", "unit"], rows), UTC)
    assert {s.name: s.unit for s in data.recording.signals}["T"] == ("degC" if words[0] == "degC" else None)
    assert values(data)["T"] == [20.5 + k for k in range(N)]
    assert not data.losses
    assert not any("unit" in n and "convert" in n for n in data.recording.notes)


def _as(folder: Path, kind: str, header: list[str], rows: list[list[object]]) -> Path:
    """The same table as a file of a kind."""
    path = folder / f"a.{kind}"
    if kind == "csv":
        path.write_text("\n".join([",".join(header), *(",".join(map(str, row)) for row in rows), ""]), "utf-8")
    elif kind == "parquet":
        pq.write_table(pa.table({name: [row[i] for row in rows] for i, name in enumerate(header)}), path)
    else:
        workbook(path, {"data": sheet([list(header), *rows])})
    return path


def test_a_unit_that_changes_behind_the_first_look_is_converted_or_a_loss(tmp_path: Path) -> None:
    rows = [f"{stamp(k // 2 / 5)},h{k % 2},{k},degC" + " " * 40 for k in range(30_000)]
    rows[10_001] = rows[10_001].replace("degC", "degF")
    rows[10_003] = rows[10_003].replace("degC", "bar")
    data = read(tmp_path / "a.csv", "time,host,T,unit", rows)
    assert [loss.reason[:46] for loss in data.losses] == ["1 row of 'h1' in another unit than 'degC': bar"]
    found = values(data)["h1/T"]
    assert 10_003 not in found
    assert found[5000] == pytest.approx((10_001 - 32) / 1.8)


def test_a_unit_beside_several_numbers_stays_a_column(tmp_path: Path) -> None:
    rows = [f"{stamp(10 * k)},h{d},{20 + d},{k},degC" for k in range(N) for d in (0, 1)]
    data = read(tmp_path / "a.csv", "time,host,T,n,unit", rows)
    assert {s.unit for s in data.recording.signals} == {None}
