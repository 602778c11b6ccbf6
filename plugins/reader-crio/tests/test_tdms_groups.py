"""A group of a TDMS file as the sheet that is declared: that group alone, called as in every other test."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_crio import Reader

from thermodata.errors import UsageError
from thermodata.plugin import Source
from thermodata.reader.contract.guard import described
from thermodata.testing.reader import load


@pytest.fixture
def two_groups(tmp_path: Path, tdms_in: Any) -> Path:
    b = tdms_in("<")
    objects = [b.channel(group, name, "float64", 3, b.wave()) for group in ("S1", "S2") for name in ("T", "Z")]
    values = [np.arange(3, dtype="<f8") + 10 * k for k in range(4)]
    path = tmp_path / "x.tdms"
    path.write_bytes(b.segment(objects, b"".join(v.tobytes() for v in values)))
    return path


@pytest.mark.parametrize(("sheet", "first"), [("S1", 0.0), ("S2", 20.0), (1, 0.0), (2, 20.0)])
def test_a_declared_sheet_is_one_group_without_its_name(two_groups: Path, sheet: int | str, first: float) -> None:
    source = Source(table={"sheet": sheet})
    data = load(Reader(), two_groups, source)
    assert [s.name for s in data.recording.signals] == ["T", "Z"]
    assert data.values["data", "T"][0] == first
    assert data.values["data", "Z"][0] == first + 10
    assert "(Z)" in Reader().locate(two_groups, source, "data", 1)


def test_without_a_sheet_all_groups_are_read_by_their_full_names(two_groups: Path) -> None:
    data = load(Reader(), two_groups, Source())
    assert [s.name for s in data.recording.signals] == ["S1/T", "S1/Z", "S2/T", "S2/Z"]


@pytest.mark.parametrize("sheet", ["S3", 3, 0])
def test_a_group_that_is_not_there_is_refused_with_those_that_are(two_groups: Path, sheet: int | str) -> None:
    with pytest.raises(UsageError) as refused:
        Reader().describe(two_groups, Source(table={"sheet": sheet}))
    assert (refused.value.where, refused.value.expected) == ("x.tdms", "1: S1, 2: S2")
    assert refused.value.got == str(sheet)


def test_a_sheet_of_an_lvm_file_is_refused_by_the_guard(tmp_path: Path) -> None:
    path = tmp_path / "x.lvm"
    path.write_bytes(Reader().heads["LVM"])
    assert described(Reader(), path, Source()).signals
    with pytest.raises(UsageError, match="knows no sheets"):
        described(Reader(), path, Source(table={"sheet": "S1"}))
