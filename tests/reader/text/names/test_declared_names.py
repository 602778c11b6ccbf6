"""Declared names are those of columns that the file does not name; else it is told that they are not used."""

from __future__ import annotations

from pathlib import Path

import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

NAMES = ["time [s]", "A [degC]", "B [um]"]


def read(tmp_path: Path, head: str, *, dated: bool = True, names: list[str] = NAMES) -> Data:
    rows = [f"{f'2026-03-02 08:{m:02d}:00' if dated else 60 * m};{20 + m / 10:.1f};{m}" for m in range(30)]
    (tmp_path / "a.csv").write_text("\n".join([*([head] if head else []), *rows, ""]), encoding="utf-8")
    return load(Reader(), tmp_path / "a.csv", Source(timezone="UTC", table={"names": names}))


@pytest.mark.parametrize("dated", [True, False])
@pytest.mark.parametrize("head", ["", "Logger 4711;;", "Logger 4711"])
def test_they_are_used_below_a_title(tmp_path: Path, head: str, dated: bool) -> None:
    data = read(tmp_path, head, dated=dated)
    assert [name for _, name in data.values] == ["A [degC]", "B [um]"]
    assert not any("declared names" in note for note in data.recording.notes)


@pytest.mark.parametrize(
    ("head", "named"), [("time [s];a;b", "a"), ("Logger;4711;x", "4711"), ("Measured by;Bob;", "Bob")]
)
def test_below_a_header_it_is_told_that_they_are_not(tmp_path: Path, head: str, named: str) -> None:
    data = read(tmp_path, head)
    assert next(iter(data.values))[1] == named
    (told,) = [note for note in data.recording.notes if "declared names" in note]
    assert f"a header names columns: '{named}'" in told


def test_they_are_refused_where_the_header_is_declared_as_well(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time [s];a;b\n" + "".join(f"{k};{k};2.5\n" for k in range(30)))
    table = {"names": NAMES, "header_rows": 1}
    with pytest.raises(FormatError, match="a header names the columns") as refused:
        load(Reader(), tmp_path / "a.csv", Source(table=table))
    assert refused.value.got == "'a'"
    assert "{skip_rows: 1, header_rows: 0, names: [...]}" in (refused.value.hint or "")
    data = load(Reader(), tmp_path / "a.csv", Source(table={"skip_rows": 1, "header_rows": 0, "names": NAMES}))
    assert [name for _, name in data.values] == ["A [degC]", "B [um]"]


def test_the_same_names_in_the_file_are_no_matter(tmp_path: Path) -> None:
    data = read(tmp_path, ";".join(NAMES), dated=False)
    assert [name for _, name in data.values] == ["A [degC]", "B [um]"]
    assert not any("declared names" in note for note in data.recording.notes)


def test_as_many_are_wanted_below_a_title_as_without(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="other columns than are declared"):
        read(tmp_path, "Logger 4711;;", names=NAMES[:2])
