"""One table in two formats is drafted once; two tables of one name are two."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.draft.labs import numbers, text, workbook
from thermodata.draft.make import draft_files


@pytest.mark.parametrize("same", [True, False])
def test_a_table_as_csv_and_as_workbook(tmp_path: Path, same: bool) -> None:
    t = np.arange(400) * 10.0
    for k in (1, 2):
        heat = 21.0 + 9.0 * k * (1 - np.exp(-t / 1500))
        text(tmp_path / f"V{k}.csv", ["t [s]", "T_hall [°C]"], [numbers(t, 0), numbers(heat, 2)], mark=",")
        shown = heat if same else heat + 3.0
        rows = [["t [s]", "T_hall [°C]"], *([float(a), float(b)] for a, b in zip(t, shown, strict=True))]
        workbook(tmp_path / f"V{k}.xlsx", {"Sheet1": rows})
    draft = draft_files(tmp_path).draft
    said = {path: why for path, why in draft.not_used if "the same table as" in why}
    assert sorted(said) == (["V1.xlsx", "V2.xlsx"] if same else [])
    assert len(draft.sources) == len(draft.channels) == (1 if same else 2)
    if same:
        assert said["V1.xlsx"].startswith("the same table as V1.csv, which is taken: 1 signal and 400 rows")
