"""A sheet that goes on under its own header, as it stood or with its units in another spelling."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import load

from .test_sheets import sheet, workbook


@pytest.mark.parametrize(
    ("again", "size", "said"),
    [
        (("t [s]", "T_vorn [°C]", "dZ [µm]"), 60, ""),
        (("t [s]", "T_vorn [degC]", "dZ [um]"), 60, ""),
        (("t [s]", "T_vorn [degC]", "dZ [mm]"), 30, "another header begins here"),
        (("t [s]", "dX [um]", "T_vorn [degC]"), 30, "another header begins here"),
    ],
)
def test_a_sheet_is_read_on_under_the_same_header(tmp_path: Path, again: tuple[str, ...], size: int, said: str) -> None:
    rows: list[list[object]] = [[10.0 * k, 20 + k / 10, k / 100] for k in range(60)]
    head: list[object] = ["t [s]", "T_vorn [°C]", "dZ [µm]"]
    data = load(
        Reader(), workbook(tmp_path / "a.xlsx", {"a": sheet([head, *rows[:30], [*again], *rows[30:]])}), Source()
    )
    (times,) = data.t_ns.values()
    assert times.size == size
    assert [loss.reason for loss in data.losses if not loss.reason.startswith(said) or not said] == []
    assert bool(data.losses) is bool(said)


@pytest.mark.parametrize(
    ("second", "columns", "size"),
    [
        (("t [s]", "dZ [um]", "T_vorn [degC]"), (0, 2, 1), 60),
        (("t [s]", "dZ [mm]", "T_vorn [degC]"), (0, 2, 1), 30),  # in another unit
        (("t [s]", "dZ [um]", "T_vorn [degC]", "n [rpm]"), (0, 2, 1, 1), 30),  # with one more
    ],
)
def test_a_sheet_is_read_on_under_a_header_in_another_order(
    tmp_path: Path, second: tuple[str, ...], columns: tuple[int, ...], size: int
) -> None:
    rows: list[list[object]] = [[10.0 * k, 20 + k / 10, k / 100] for k in range(60)]
    moved: list[list[object]] = [[row[c] for c in columns] for row in rows[30:]]
    head: list[object] = ["t [s]", "T_vorn [°C]", "dZ [µm]"]
    path = workbook(tmp_path / "a.xlsx", {"a": sheet([head, *rows[:30], [*second], *moved])})
    data = load(Reader(), path, Source())
    (times,) = data.t_ns.values()
    assert times.size == size
    assert bool(data.losses) is (size == 30)
    values = {name: v for (_, name), v in data.values.items()}
    np.testing.assert_allclose(values["dZ [µm]"], np.arange(size) / 100)
    np.testing.assert_allclose(values["T_vorn [°C]"], 20 + np.arange(size) / 10)
    assert Reader().locate(path, Source(), next(iter(data.t_ns)), 29) == "sheet 'a', row 31"
    if size == 60:  # the second header is a row of the sheet
        assert Reader().locate(path, Source(), next(iter(data.t_ns)), 30) == "sheet 'a', row 33"
