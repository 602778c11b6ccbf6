"""A year of two digits that may stand at either end is told by logs of the same days, and asked beside others."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import pytest

from thermodata.draft.make import draft_files


def log(path: Path, first: datetime, form: str, columns: str) -> None:
    rows = [
        ",".join([f"{first + timedelta(minutes=k):{form} %H:%M:%S}", *(f"{20 + k / 50 + i:.2f}" for i in range(2))])
        for k in range(120)
    ]
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join([f"time,{columns}", *rows, ""]), "utf-8")


@pytest.mark.parametrize(
    ("written", "beside", "told"),
    [
        ("%y-%m-%d", datetime(2026, 7, 6, 9), "%y-%m-%d %H:%M:%S"),
        ("%d-%m-%y", datetime(2006, 7, 26, 9), "dmy"),  # by the same letters
        ("%y-%m-%d", datetime(2026, 3, 2, 9), None),  # of other days
        ("%y-%m-%d", None, None),
    ],
)
def test_the_end_at_which_the_year_stands(
    tmp_path: Path, written: str, beside: datetime | None, told: str | None
) -> None:
    first = datetime(2006, 7, 26, 8) if written.startswith("%d") else datetime(2026, 7, 6, 8)
    for day in range(2):
        log(tmp_path / f"lr/AUTO000{day}.csv", first + timedelta(days=day), written, "Z [um],n [rpm]")
        if beside is not None:
            log(tmp_path / f"gl/T{day}.csv", beside + timedelta(days=day), "%Y-%m-%d", "T1 [degC],T2 [degC]")
    sources = draft_files(tmp_path).draft.sources
    (source,) = [s for s in sources if s.files is not None and s.files.startswith("lr/")]
    assert (source.table or {}).get("time", {}).get("format") == (told or "unknown")
    assert any(" or dmy?" in q for q in source.questions) is (told is None)
    if told:
        assert any(f"dates {told}: so they are of the days of T0.csv" in said for said in source.told)
