"""A sheet that goes on under its own header, as it stood or with its units in another spelling."""

from __future__ import annotations

from pathlib import Path

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
        (("t [s]", "dZ [um]", "T_vorn [degC]"), 30, "another header begins here"),
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
