"""Text of fixed width with blank cells: what stands behind one stays in its own column, or its row is lost whole."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

WIDTHS = (9, 8, 8, 7)
NAMES = ("t_min", "dZ", "dY", "T")


def right(cells: list[str]) -> str:
    return "".join(c.rjust(w) for c, w in zip(cells, WIDTHS, strict=True))


def left(cells: list[str]) -> str:
    return "".join(c.ljust(w) for c, w in zip(cells, WIDTHS, strict=True))


def rows(blank: dict[int, int]) -> list[list[str]]:
    """120 rows; blank: row -> its column without a value."""
    made = [[f"{k / 5:.1f}", f"{k / 10:.1f}", f"{-k / 4:.2f}", f"{21 + k / 20:.1f}"] for k in range(120)]
    for row, column in blank.items():
        made[row][column] = ""
    return made


def read(folder: Path, lines: list[str]) -> Data:
    path = folder / "a.txt"
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")
    return load(Reader(), path, Source(table={"time": {"column": 1, "unit": "min"}}))


def holes(data: Data) -> dict[int, int]:
    """Row -> the column that has no value there."""
    return {
        int(row): NAMES.index(name)
        for (_, name), values in data.values.items()
        for row in np.flatnonzero(np.isnan(values))
    }


@pytest.mark.parametrize("form", [right, left])
@pytest.mark.parametrize("blank", [{40: 1}, {40: 1, 41: 2, 90: 3}])
def test_a_blank_cell_is_a_missing_value_of_its_column(
    tmp_path: Path, form: Callable[[list[str]], str], blank: dict[int, int]
) -> None:
    data = read(tmp_path, [form(list(NAMES)), *map(form, rows(blank))])
    assert holes(data) == blank
    assert data.t_ns["table"].size == 120
    assert not data.losses
    sound = read(tmp_path, [form(list(NAMES)), *map(form, rows({}))])
    for key, values in sound.values.items():
        keep = np.isfinite(data.values[key])
        assert np.array_equal(data.values[key][keep], values[keep])


def test_a_blank_cell_far_down_is_one_too(tmp_path: Path) -> None:
    made = [*rows({}), *rows({})] * 40
    made = [[f"{k / 5:.1f}", *row[1:]] for k, row in enumerate(made)]
    made[-50] = [made[-50][0], made[-50][1], "", made[-50][3]]
    data = read(tmp_path, [right(list(NAMES)), *map(right, made)])
    assert holes(data) == {len(made) - 50: 2}


def test_names_with_blanks_stand_over_their_columns(tmp_path: Path) -> None:
    head = [
        "Měření deformací   stroj MCV 750",
        right(["min", "um", "um", "°C"]),
        right(["čas", "sn. Z", "sn. Y", "T p"]),
    ]
    data = read(tmp_path, [*head, *map(right, rows({40: 1}))])
    assert [(s.name, s.unit) for s in data.recording.signals] == [("sn. Z", "um"), ("sn. Y", "um"), ("T p", "°C")]
    assert np.isnan(data.values["table", "sn. Z"]).sum() == 1


def test_where_most_rows_have_blank_cells_the_text_is_refused_with_what_to_do(tmp_path: Path) -> None:
    blank = {k: 1 + k % 3 for k in range(30, 100)}
    with pytest.raises(FormatError, match="no columns found") as caught:
        read(tmp_path, [right(list(NAMES)), *map(right, rows(blank))])
    assert "read_fwf" in (caught.value.hint or "")


def test_names_that_go_over_the_edges_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="more cells than the rows"):
        read(tmp_path, ["t_min probe Z of table probe Y at top T", *map(right, rows({}))])


@pytest.mark.parametrize(
    "short",
    [
        lambda cells: " ".join(c for c in cells if c),  # the cells behind moved up
        lambda cells: " ".join(cells),  # nothing between two blanks
    ],
)
def test_where_cells_stand_at_no_fixed_places_the_row_is_lost_and_nothing_moves(
    tmp_path: Path, short: Callable[[list[str]], str]
) -> None:
    data = read(tmp_path, [" ".join(NAMES), *map(short, rows({40: 1, 60: 2}))])
    assert data.t_ns["table"].size == 118
    assert not holes(data)
    assert sum("3" in loss.reason for loss in data.losses) == 2


def test_equal_lengths_alone_do_not_tell_a_cell_that_is_blank_at_the_end_from_one_that_moved(tmp_path: Path) -> None:
    made = [f"{10 + k / 5:.1f} {20 + k / 10:.1f} {30 + k / 50:.1f}" for k in range(120)]
    made[50] = made[50][:4] + made[50][10:]  # the middle one is gone, and the last one stands in its place
    data = read(tmp_path, ["t_min dZ T", *made])
    assert data.t_ns["table"].size == 119
    assert not np.isnan(data.values["table", "dZ"]).any()
