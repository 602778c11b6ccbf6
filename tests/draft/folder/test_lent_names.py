"""Files of a logger that writes its names into the first of them only."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from thermodata.draft.make import draft_files

HEAD = "time,T_bed_C,dZ_um"


def part(folder: Path, name: str, start: str, head: str | None, columns: int = 2, rows: int = 100) -> None:
    at = np.datetime64(f"2026-03-02 {start}") + 10 * np.arange(rows).astype("timedelta64[s]")
    rows_of = (
        (str(t).replace("T", " "), *(f"{20 + k + i / 99:.3f}" for k in range(columns))) for i, t in enumerate(at)
    )
    lines = [",".join(cells) for cells in rows_of]
    (folder / name).write_text("\n".join([*([head] if head else []), *lines, ""]))


def test_parts_without_a_header_have_the_names_of_the_first(tmp_path: Path, say: Say) -> None:
    for k, head in enumerate((HEAD, None, None)):
        part(tmp_path, f"run_{k:03}.csv", f"08:{16 * k:02}:40", head)
    draft = draft_files(tmp_path).draft
    assert [t.id for t in draft.tests] == ["run"]
    assert [c.signal for c in draft.channels] == ["T_bed_C", "dZ_um"]
    (source,) = draft.sources
    assert source.table == {"names": ["time", "T_bed_C", "dZ_um"]}
    said = "names? 2 files without a header, e.g. run_001.csv: those of run_000.csv are taken"
    assert source.questions[0] == said
    assert say("--store", tmp_path / "s", "ingest", tmp_path / "campaign.yaml").code == 0
    found = say("--store", tmp_path / "s", "sql", "select count(*) n from sample where value is not null", "--csv")
    assert found.out.split() == ["n", "600"]


@pytest.mark.parametrize("same", [True, False])
def test_pieces_put_aside_have_the_names_of_the_oldest(tmp_path: Path, same: bool, say: Say) -> None:
    for k, head in enumerate((HEAD, None, None)):
        name = f"m0.log.{2 - k}".removesuffix(".0")
        part(tmp_path, name, f"08:{16 * k:02}:40", head, 2 if same or not k else 3)
    draft = draft_files(tmp_path).draft
    names = {"names": ["time", "T_bed_C", "dZ_um"]}
    assert [s.table for s in draft.sources] == ([names] if same else [{}, {}])
    if same:
        asked = "names? 2 files without a header, e.g. m0.log: those of m0.log.2 are taken"
        assert draft.sources[0].questions[0] == asked
        assert say("--store", tmp_path / "s", "ingest", tmp_path / "campaign.yaml").code == 0
        found = say("--store", tmp_path / "s", "sql", "select count(*) n from sample where value is not null", "--csv")
        assert found.out.split() == ["n", "600"]


def test_a_unit_of_the_time_goes_with_the_names(tmp_path: Path) -> None:
    for k, head in enumerate(("t [min],T_bed_C", None)):
        lines = [f"{100 * k + i},{20 + i / 99:.3f}" for i in range(100)]
        (tmp_path / f"run_{k}.csv").write_text("\n".join([*([head] if head else []), *lines, ""]))
    (source,) = draft_files(tmp_path).draft.sources
    assert source.table == {"names": ["t [min]", "T_bed_C"]}
    assert not any("unit" in q for q in source.questions)


@pytest.mark.parametrize(
    ("heads", "columns"),
    [
        ((HEAD, None), (2, 3)),  # another logger's
        ((HEAD, "time,T_hall,dZ_um", None), (2, 2, 2)),  # of whom?
    ],
    ids=["columns", "heads"],
)
def test_names_that_may_be_of_others_are_not_lent(
    tmp_path: Path, heads: tuple[str | None, ...], columns: tuple[int, ...]
) -> None:
    for k, (head, many) in enumerate(zip(heads, columns, strict=True)):
        part(tmp_path, f"run_{k:03}.csv", f"08:{16 * k:02}:40", head, many)
    draft = draft_files(tmp_path).draft
    assert any(c.signal == "column 2" for c in draft.channels)
    assert not any("names" in s.table for s in draft.sources)


def test_a_file_of_another_name_keeps_its_columns(tmp_path: Path) -> None:
    part(tmp_path, "run_000.csv", "08:00:00", HEAD)
    part(tmp_path, "hall.csv", "08:00:00", None)
    assert any(c.signal == "column 2" for c in draft_files(tmp_path).draft.channels)
