"""A table of tests in a workbook, where nothing is installed that opens workbooks."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from thermodata.draft.campaign.plan import plan
from thermodata.draft.folder.scan import scan
from thermodata.draft.folder.table import closed_workbooks

from .labs import LABS


def test_the_draft_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    LABS["workbooks"](tmp_path)
    found = scan(tmp_path)
    assert not any("python-calamine" in n for n in plan("shop", tmp_path, found).notes)
    monkeypatch.setitem(sys.modules, "python_calamine", None)
    (note,) = closed_workbooks([*found.others, "raw/photo.jpg", "test_list.csv", "prices.xlsx"])
    assert note.startswith("test_plan.xlsx was not opened")
    assert "try: pip install 'thermodata[workbook]'" in note
    assert note in plan("shop", tmp_path, found).notes
