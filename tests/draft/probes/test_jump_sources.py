"""A jump test in a sheet beside the sheets of tests has a source of its own; one in a file of its own needs none."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.draft.labs import workbook
from thermodata.draft.make import draft_files
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

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


def capacitive(folder: Path, name: str, mm: list[float], *more: tuple[str, list[float]]) -> None:
    """A log of a sensor whose channels are lengths in mm, called by their numbers."""
    head = ["Zeit [s]", "Kanal 1 [mm]", *(n for n, _ in more)]
    rows = zip(mm, *(values for _, values in more), strict=True)
    lines = [";".join(map(str, (i, *row))) for i, row in enumerate(rows)]
    (folder / f"{name}.csv").write_text("\n".join([";".join(head), *lines, ""]))


@pytest.mark.parametrize("name", ["Sprungtest_Z_capa", "Schwingung_Z"])
def test_a_probe_in_mm_moves_in_a_file_that_is_called_a_jump_test(tmp_path: Path, name: str) -> None:
    for test in ("V1", "V2"):
        capacitive(tmp_path, test, [0.5 + 1e-5 * i for i in range(900)])
    capacitive(tmp_path, name, [v / 10 for v in staircase()])
    draft = draft_files(tmp_path).draft
    (probe,) = draft.channels
    named = name.startswith("Sprung")
    assert [(j.file, j.axis, j.unit) for j in draft.jumps] == ([(f"{name}.csv", "Z", "mm")] if named else [])
    assert probe.said.quantity == ("displacement" if named else "position")
    assert (name in [t.id for t in draft.tests]) is not named
    if named:
        assert probe.said.questions == (f"axis: Z by {name}.csv?",)
        assert "until they stand here, Kanal_1 has no values" in draft.jumps[0].question


@pytest.mark.parametrize(
    "other",
    [("Weg X [mm]", [0.9 * i for i in range(240)]), ("Drehzahl [rpm]", [3000.0] * 240)],
    ids=["axis", "spindle"],
)
def test_an_axis_that_travels_and_a_spindle_that_turns_are_no_jump_test(
    tmp_path: Path, other: tuple[str, list[float]]
) -> None:
    capacitive(tmp_path, "Sprung_Z", [5.0] * 240, other)
    assert not draft_files(tmp_path).draft.jumps


def test_what_is_called_as_an_axis_beside_a_spindle_is_its_position(tmp_path: Path) -> None:
    for test, values in (("V1", [0.5 + 1e-5 * i for i in range(900)]), ("Sprung_Z", [v / 10 for v in staircase()])):
        capacitive(tmp_path, test, values, ("Drehzahl [rpm]", [0.0] * len(values)))
        path = tmp_path / f"{test}.csv"
        path.write_text(path.read_text().replace("Kanal 1 [mm]", "Z [mm]"))
    assert not draft_files(tmp_path).draft.jumps
