"""Columns without a name are called by their place, and that is noted of no other."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.plugin import Source
from thermodata.reader.text.tables.find_table import open_table


@pytest.mark.parametrize(
    ("header", "noted"),
    [
        ("time,column front [degC],room [degC]", False),
        ("time,column 7 [degC],room [degC]", False),
        ("time,front [degC],room [degC]", False),
        ("time,,room [degC]", True),
    ],
)
def test_a_name_may_begin_with_the_word_column(tmp_path: Path, header: str, noted: bool) -> None:
    path = tmp_path / "a.csv"
    rows = [f"2026-04-29 11:00:{10 * i:02d},{23 + 0.1 * i:.1f},{21 + 0.1 * i:.1f}" for i in range(6)]
    path.write_text("\n".join([header, *rows]) + "\n", "utf-8")
    table = open_table(path, Source())
    assert ("columns without a name are called by their place" in table.notes) is noted
