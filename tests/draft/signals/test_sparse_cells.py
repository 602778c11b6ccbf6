"""Columns of few cells: whether their values stand is asked in the draft, and the answer is read."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from thermodata.draft.make import draft_files
from thermodata.plugin import Source
from thermodata.reader.text import delimited


def _log(folder: Path, every: int) -> Path:
    """Ten minutes at 1 s; temperature and speed in every n-th row."""
    rows = [
        f"2026-05-11T06:{i // 60:02d}:{i % 60:02d}Z,{i / 100:.2f},"
        + ("," if i % every else f"{21 + i / 1000:.2f},{3000 if i // 200 == 1 else 0}")
        for i in range(600)
    ]
    path = folder / "day.csv"
    path.write_text("\n".join(["time,dZ [um],T_bed [degC],n", *rows, ""]), "utf-8")
    return path


def test_cells_in_every_tenth_row_are_asked_and_the_answer_is_read(tmp_path: Path) -> None:
    path = _log(tmp_path, 10)
    (source,) = draft_files(tmp_path).draft.sources
    [asked] = [q for q in source.questions if q.startswith("stands:")]
    assert "'T_bed [degC]', 'n': most cells are empty: where each stands until the next one" in asked
    told = yaml.safe_load(asked.partition("table: ")[2].partition("}")[0] + "}")
    assert told == {"stands": ["T_bed [degC]", "n"]}
    table = delimited.open_table(path, Source(table=told))
    assert len(table.stands) == 2


@pytest.mark.parametrize("every", [1, 2])
def test_cells_in_most_rows_are_not(tmp_path: Path, every: int) -> None:
    _log(tmp_path, every)
    (source,) = draft_files(tmp_path).draft.sources
    assert not [q for q in source.questions if q.startswith("stands:")]
