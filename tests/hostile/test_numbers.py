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


def test_the_minus_of_typography_and_an_exponent_of_fortran_are_numbers(lab: Lab) -> None:
    cells = ["\u2212" * (i % 2) + f"{i / 8}" for i in range(40)]
    fortran = [f"{2 + i / 8:.4E}".replace("E", "D") for i in range(40)]
    lines = "".join(f"{t},{a},{b}\n" for t, a, b in zip(TIMES, cells, fortran, strict=True))
    lab.write("raw/a.csv", "time,X [um],T_spindle [degC]\n" + lines)
    assert lab("init", lab.folder).code == 0
    assert lab("ingest", lab.folder / "campaign.yaml").code == 0
    np.testing.assert_allclose(lab.values("X", "a")[1], [(-1) ** i * i / 8 for i in range(40)])
    np.testing.assert_allclose(lab.values("T_spindle", "a")[1], [2 + i / 8 for i in range(40)])


@pytest.mark.parametrize("by", ["table", "cnc"])
@pytest.mark.parametrize(
    ("cell", "value"), [("0,2-", -0.2), ("(0,2)", -0.2), ("1.234,50-", -1234.5), ("(1.234,50)", -1234.5)]
)
def test_a_minus_behind_a_number_and_brackets_around_it_make_it_negative(
    read: Any, by: str, cell: str, value: float
) -> None:
    data = read(csv(["12,5", cell]), by=by)
    np.testing.assert_array_equal(column(data)[:2], [12.5, value])
    assert data.losses == ()


@pytest.mark.parametrize("word", ["1D3", "12D+3", "D+03", "5−", "1−2", "−", "5-", "(5)", "-1.5-", "(-1.5)"])
def test_words_with_a_d_or_a_minus_stay_words(read: Any, word: str) -> None:
    data = read(csv(["1.5"] * 30 + [word] + ["1.5"] * 9))
    assert np.isnan(next(iter(data.values.values()))[30])


FULL_WIDTH = {48 + k: 0xFF10 + k for k in range(10)}


@pytest.mark.parametrize(
    ("cells", "said"),
    [
        (["cold", "warm"] * 20, "text, though degC is a unit of numbers"),
        # read as numbers at ingest, and never taken for sure
        (
            [f"{20 + i / 8}".translate(FULL_WIDTH) for i in range(40)],
            "quantity: temperature, unit: degC, at: spindle}   # guess",
        ),
    ],
)
def test_a_unit_of_numbers_over_words_is_asked_about_and_kept_as_no_label(
    lab: Lab, cells: list[str], said: str
) -> None:
    lab.write("raw/a.csv", csv(cells, head="T_spindle [degC]"))
    assert lab("init", lab.folder).code == 0
    drafted = (lab.folder / "campaign.yaml").read_text(encoding="utf-8")
    assert "quantity: label" not in drafted
    assert said in drafted


def test_a_file_of_both_decimal_marks_is_drafted_with_the_question(lab: Lab) -> None:
    lines = "".join(f"{t};{20 + i / 8};{i},5\n" for i, t in enumerate(TIMES))
    lab.write("raw/a.csv", "time;T_spindle [degC];X [um]\n" + lines)
    assert lab("init", lab.folder).code == 0
    drafted = lab.folder / "campaign.yaml"
    text = drafted.read_text(encoding="utf-8")
    assert "decimal: unknown" in text
    assert "40 with a comma" in text
    assert lab("ingest", drafted).code == 3
    drafted.write_text(text.replace("decimal: unknown", 'decimal: "."'), encoding="utf-8")
    lab("ingest", drafted)
    np.testing.assert_allclose(lab.values("T_spindle", "a")[1], [20 + i / 8 for i in range(40)])
