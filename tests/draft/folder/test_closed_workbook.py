"""A table of tests in a workbook, where nothing is installed that opens workbooks, or nothing may."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.draft.labs import LABS
from thermodata.archive import workbook as archived_workbook
from thermodata.draft.campaign.plan import plan
from thermodata.draft.folder.beside.table import closed_workbooks, grids_of
from thermodata.draft.folder.scan import scan


def test_the_draft_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    LABS["workbooks"](tmp_path)
    found = scan(tmp_path)
    assert not any("python-calamine" in n for n in plan("shop", tmp_path, found).notes)
    monkeypatch.setitem(sys.modules, "python_calamine", None)
    (note,) = closed_workbooks([*found.others, "raw/photo.jpg", "test_list.csv", "prices.xlsx"])
    assert note.startswith("test_plan.xlsx was not opened")
    assert "try: pip install 'thermodata[workbook]'" in note
    assert note in plan("shop", tmp_path, found).notes


def test_what_is_absurd_once_it_is_laid_out_is_not_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A stray cell in the last row and column is 550 GB once somebody lays it out: the process would be gone."""
    LABS["workbooks"](tmp_path)
    table = tmp_path / "test_plan.xlsx"
    assert list(grids_of(table, 1000))
    monkeypatch.setattr(archived_workbook, "MAX_ROWS", 2)
    assert not list(grids_of(table, 1000))
