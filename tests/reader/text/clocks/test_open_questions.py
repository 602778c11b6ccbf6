"""What a table does not say is asked, refused while it is unknown, and read once it is declared."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited

S = 1_000_000_000


def read(path: Path, **table: Any) -> tuple[list[int], list[float], list[str]]:
    """(times [ns], values of the last column, reasons of losses)."""
    source = Source(table=table or None)
    items = list(delimited.blocks(path, delimited.open_table(path, source), source))
    blocks = [b for b in items if isinstance(b, Block)]
    name = list(blocks[0].values)[-1] if blocks else ""
    return (
        [int(t) for b in blocks for t in b.t_ns],
        [float(v) for b in blocks for v in b.values[name]],
        [x.reason for x in items if not isinstance(x, Block)],
    )


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


UNDATED = "T;Z [um]\n" + "".join(f"{20 + i / 10:.1f};{i}.5\n" for i in range(12))
UNITLESS = "Zeit;Z [um]\n" + "".join(f"{i};{i}.5\n" for i in range(12))
EITHER = "Date;Z [um]\n" + "".join(f"03/04/2026 08:00:{i:02};{i}.5\n" for i in range(12))


@pytest.mark.parametrize(
    ("text", "declare"),
    [
        (UNDATED, {"time": {"period": "unknown"}}),
        (UNITLESS, {"time": {"unit": "unknown"}}),
        (EITHER, {"time": {"format": "unknown"}}),
        (UNITLESS.split("\n", 1)[1], {"time": {"column": 1, "unit": "unknown"}}),
    ],
)
def test_a_table_that_leaves_a_question_asks_it_and_reads_with_an_answer_for_the_time_being(
    text: str, declare: dict[str, Any], tmp_path: Path
) -> None:
    path = write(tmp_path / "a.csv", text)
    with pytest.raises(QuestionError) as raised:
        read(path)
    assert raised.value.declare == declare
    assert "?" in raised.value.ask
    assert len(read(path, **raised.value.meanwhile)[0]) == 12
    with pytest.raises(FormatError, match="not answered yet") as refused:
        read(path, **declare)
    assert not isinstance(refused.value, QuestionError)


@pytest.mark.parametrize("period", ["90 s", "1.5 min", 90.0])
def test_rows_at_a_period_are_counted(period: str | float, tmp_path: Path) -> None:
    times, values, losses = read(write(tmp_path / "a.csv", UNDATED), time={"period": period})
    assert times == [i * 90 * S for i in range(12)]
    assert values == [i + 0.5 for i in range(12)]
    assert losses == []


def test_a_lost_row_took_its_time_and_a_repeated_header_none(tmp_path: Path) -> None:
    lines = UNDATED.splitlines(keepends=True)
    lines[3] = "20.2\n"  # a cell is missing
    lines[5] = ";\n"  # no values, but a row
    lines.insert(8, lines[0])
    times, values, losses = read(write(tmp_path / "a.csv", "".join(lines)), time={"period": "1 s"})
    assert times == [i * S for i in range(12) if i != 2]
    assert np.isnan(values[3])
    assert values[-1] == 11.5
    assert losses == ["expected 2 cells, got 1: '20.2'"]


def test_counting_goes_on_over_chunks(tmp_path: Path) -> None:
    n = 400_000
    path = write(tmp_path / "a.csv", "T;Z [um]\n" + "".join(f"20.1;{i % 10}.5\n" for i in range(n)))
    times, _, losses = read(path, time={"period": "0.1 s"})
    assert len(times) == n
    assert np.array_equal(np.array(times), np.arange(n, dtype=np.int64) * (S // 10))
    assert losses == []


@pytest.mark.parametrize(("order", "month"), [("dmy", 4), ("mdy", 3)])
def test_the_order_of_day_and_month_is_declared_by_its_letters(order: str, month: int, tmp_path: Path) -> None:
    times, _, _ = read(write(tmp_path / "a.csv", EITHER), time={"format": order})
    assert np.datetime64(times[0], "ns").astype("datetime64[M]").item().month == month


@pytest.mark.parametrize(
    ("name", "each"), [("time_s", 1), ("Time [s]", 1), ("elapsed (min)", 60), ("Zeit in h", 3600), ("t_min", 60)]
)
def test_a_name_that_says_its_unit_is_not_asked(name: str, each: int, tmp_path: Path) -> None:
    path = write(tmp_path / "a.csv", UNITLESS.replace("Zeit", name))
    assert read(path)[0][1] == each * S


def test_a_short_list_of_numbers_is_no_recording(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="no time column") as error:
        read(write(tmp_path / "a.csv", "\n".join(UNDATED.splitlines()[:5]) + "\n"))
    assert not isinstance(error.value, QuestionError)


def excel(header: str, step_days: float = 5 / 86_400, first: float = 46_083 + 1 / 3) -> str:
    rows = "".join(f"{first + i * step_days:.9f}".replace(".", ",") + f";{i},5\n" for i in range(12))
    return f"{header};Z [um]\n{rows}"


@pytest.mark.parametrize("header", ["Datum/Zeit", "Datum Uhrzeit", "Date and time", "Datum und Zeit", "Datum"])
def test_days_under_a_word_for_date_and_time_are_excels(header: str, tmp_path: Path) -> None:
    times, _, _ = read(write(tmp_path / "a.csv", excel(header)))
    assert times[0] == pytest.approx(1_772_438_400 * S, abs=S // 1000)
    assert times[-1] - times[0] == pytest.approx(55 * S, abs=S // 1000)


def test_days_under_a_word_for_time_alone_are_asked(tmp_path: Path) -> None:
    with pytest.raises(QuestionError, match="Excel's days or seconds"):
        read(write(tmp_path / "a.csv", excel("Zeit")))


@pytest.mark.parametrize(("first", "unit"), [(46_083 + 1 / 3, "excel"), (100.0, "unknown")])
def test_the_advice_for_a_column_that_only_rises_has_the_unit_of_its_size(
    first: float, unit: str, tmp_path: Path
) -> None:
    with pytest.raises(QuestionError) as raised:
        read(write(tmp_path / "a.csv", excel("Messung", first=first)))
    assert f"time: {{column: 1, unit: {unit}}}" in raised.value.ask
