"""A jump test in a sheet beside the sheets of tests has a source of its own; one in a file of its own needs none."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

from .labs import workbook

Rows = list[list[object]]


def sheet(volts: list[float]) -> Rows:
    return [["Zeit [s]", "Taster_Z [V]"], *([float(i), v] for i, v in enumerate(volts))]


def staircase() -> list[float]:
    return [5.0 + 0.001 * (i % 3) + level for level in (0, -1, -2, 0) for i in range(60)]


def logs() -> dict[str, Rows]:
    return {t: sheet([5 + 1e-4 * i for i in range(900)]) for t in ("V1", "V2")}


@pytest.mark.parametrize("inside", [True, False])
def test_a_jump_sheet_is_read_by_a_source_of_its_own(tmp_path: Path, inside: bool) -> None:
    jump = {"Sprung Z": sheet(staircase())}
    workbook(tmp_path / "Messung.xlsx", logs() | (jump if inside else {}))
    if not inside:
        workbook(tmp_path / "Sprung_Z.xlsx", jump)
    draft = draft_files(tmp_path).draft
    (calibration,) = draft.jumps
    (own,) = [s for s in draft.sources if s.name == calibration.source]
    assert own.table.get("sheet") == ("Sprung Z" if inside else None)
    path = tmp_path / "campaign.yaml"
    path.write_text(path.read_text().replace("moves: unknown", "moves: [50 um, 50 um, -100 um]"))
    summary = ingest(Store(tmp_path / "s.store", create=True), path)
    assert not [x for x in summary.losses if "sheet" in str(x)]
    assert summary.samples == 1800


def test_a_jump_test_among_tables_keeps_the_source_of_the_tests(tmp_path: Path) -> None:
    for name, rows in (logs() | {"Sprung_Z": sheet(staircase())}).items():
        (tmp_path / f"{name}.csv").write_text("".join(";".join(map(str, r)) + "\n" for r in rows))
    draft = draft_files(tmp_path).draft
    assert [j.source for j in draft.jumps] == [draft.sources[0].name]
    assert len(draft.sources) == 1
