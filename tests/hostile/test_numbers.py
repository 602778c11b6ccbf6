"""Numbers as labs write them: each is right, or a loss with its place, or asked for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from thermodata.errors import FormatError
from thermodata.testing.reader import Data

from .conftest import Lab
from .test_times import T1, stamps

TIMES = stamps("2026-03-02 08:00:00", 10, 40)


def csv(cells: list[str], between: str = ";", head: str = "T") -> str:
    made = (cells * 40)[:40]
    return f"time{between}{head}\n" + "".join(f"{t}{between}{c}\n" for t, c in zip(TIMES, made, strict=True))


def column(data: Data) -> Any:
    return next(iter(data.values.values()))


@pytest.mark.parametrize(
    ("cells", "between", "fraction", "thousands"),
    [
        (['"20,512"'], ",", (",", 20.512), (".", 20512.0)),
        (["1.500"], ";", (".", 1.5), (",", 1500.0)),
        (["1.500", "12.250", "999"], ";", (".", 1.5), (",", 1500.0)),
    ],
)
def test_a_mark_that_may_part_thousands_is_asked_for_and_can_be_declared(
    lab: Lab, cells: list[str], between: str, fraction: tuple[str, float], thousands: tuple[str, float]
) -> None:
    lab.write("raw/a.csv", csv(cells, between))
    said = lab.ingest(T1)
    assert said.code == 3
    assert "may part thousands or begin a fraction" in said.out + said.err
    assert "table: {decimal:" in said.out + said.err
    for mark, value in (fraction, thousands):
        assert lab.ingest(T1, {"table": {"decimal": mark}}).code == 0
        assert lab.values("T1")[1][0] == value


@pytest.mark.parametrize("proof", ["0.250", "1.25", "1234.500", "12000", "-0.003", "1.5e3"])
def test_one_number_that_can_only_be_read_one_way_decides_for_the_file(read: Any, proof: str) -> None:
    data = read(csv(["1.500", "20.125", proof]))
    np.testing.assert_array_equal(column(data)[:3], [1.5, 20.125, float(proof)])


@pytest.mark.parametrize("by", ["table", "cnc"])
@pytest.mark.parametrize(("cell", "value"), [("1 500", 1500.0), ("1'500", 1500.0), ("1 500,5", 1500.5)])
def test_parted_thousands_are_numbers_whoever_reads(read: Any, by: str, cell: str, value: float) -> None:
    data = read(csv(["12,5", cell]), by=by)
    np.testing.assert_array_equal(column(data)[:2], [12.5, value])
    assert data.losses == ()


@pytest.mark.parametrize("by", ["table", "cnc"])
@pytest.mark.parametrize("cell", ["20,0 °C", "0x1F", "=A1*2", "12 %"])
def test_what_is_no_number_is_a_loss_with_its_line(read: Any, by: str, cell: str) -> None:
    data = read(csv([*["12,5"] * 9, cell]), by=by)
    assert np.isnan(column(data)[9])
    assert len(data.losses) == 4
    assert "line 11" in data.losses[0].where
    assert cell in data.losses[0].reason


@pytest.mark.parametrize("cell", ["20,0 °C", "0x1F", "=A1*2"])
def test_a_column_of_such_cells_for_a_number_is_said(lab: Lab, cell: str) -> None:
    lab.write("raw/a.csv", csv([cell]))
    said = lab.ingest(T1)
    assert said.code == 3
    assert "T1" in said.out + said.err
    assert cell in said.out + said.err


@pytest.mark.parametrize(("mark", "lost"), [(".", "B"), (",", "A")])
def test_a_declared_mark_holds_in_a_file_of_both(read: Any, mark: str, lost: str) -> None:
    text = csv(["1.5;20,5"], head="A;B")
    with pytest.raises(FormatError, match="a decimal point and with a decimal comma"):
        read(text)
    data = read(text, table={"decimal": mark})
    assert all(f"column '{lost}'" in x.where or "more" in x.reason for x in data.losses)
    assert data.losses
