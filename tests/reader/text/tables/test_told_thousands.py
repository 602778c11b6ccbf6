"""Points that part thousands beside decimal commas, where the numbers of the file tell it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from thermodata.errors import QuestionError
from thermodata.plugin import Block, Loss, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.tables.sample.told_thousands import told_thousands

TEMPERATURES = [f"2{k % 9},{k % 7}4" for k in range(60)]


def german(value: int) -> str:
    return f"{value:,}".replace(",", ".")


def _read(folder: Path, columns: Sequence[Sequence[str]]) -> tuple[list[list[float]], list[Loss], tuple[str, ...]]:
    rows = [f"2026-03-02 08:{k:02d}:00;" + ";".join(cells) for k, cells in enumerate(zip(*columns, strict=True))]
    names = ";".join(["time", *(f"c{i}" for i in range(len(columns)))])
    (folder / "a.csv").write_text("\n".join([names, *rows, ""]))
    table = delimited.open_table(folder / "a.csv", Source())
    parts = list(delimited.blocks(folder / "a.csv", table, Source()))
    values = [[float(x) for b in parts if isinstance(b, Block) for x in b.values[f"c{i}"]] for i in range(len(columns))]
    return values, [p for p in parts if isinstance(p, Loss)], delimited.describe(table, Source()).notes


def test_thousands_that_the_file_proves_are_read(tmp_path: Path) -> None:
    nanometers = [german(-1840 + 150 * k) for k in range(60)]
    speed = [german(3000) if k % 3 else "0" for k in range(60)]
    assert "-1.840" in nanometers
    assert "-490" in nanometers
    values, losses, notes = _read(tmp_path, [TEMPERATURES, nanometers, speed])
    assert values[1] == [-1840 + 150 * k for k in range(60)]
    assert set(values[2]) == {0.0, 3000.0}
    assert values[0][0] == 20.04
    assert losses == []
    assert any("'.' parts thousands ('-1.840'), for ',' begins fractions ('20,04')" in n for n in notes)


@pytest.mark.parametrize(
    "other",
    [
        [f"{1.5 + k / 8:.3f}" for k in range(60)],  # of a fixed format: volts, as they may be
        [f"{k - 30:.3f}" if k != 30 else "0" for k in range(60)],
        [german(900 + 40 * k) if k % 2 else str(900 + 40 * k) for k in range(60)],  # thousands without a point too
        [german(900 + 40 * k) if k else "0.5" for k in range(60)],  # a fraction with a point
        [german(8000) if k % 2 else "950" for k in range(60)],  # two numbers show no way to write them
    ],
    ids=["fixed", "zero", "unparted", "fraction", "few"],
)
def test_numbers_that_may_be_written_in_two_ways_are_asked(tmp_path: Path, other: list[str]) -> None:
    with pytest.raises(QuestionError) as asked:
        _read(tmp_path, [TEMPERATURES, other])
    assert asked.value.declare == {"decimal": "unknown"}


def test_commas_alone_or_without_a_fraction_tell_nothing() -> None:
    assert told_thousands([["1.500", "900", "2.500"]]) is None
    assert told_thousands([["1.500", "900"], ["1,250", "3,500"]]) is None
    assert told_thousands([TEMPERATURES]) is None
    english = told_thousands([["1,500", "900", "12,500.25", "-20", "8,000", "7"], ["20.04", "21.5"]])
    assert english is not None
    assert english.decimal == "."
