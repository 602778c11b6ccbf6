"""A unit in a name that contradicts the file's is asked in the draft, told by the preview and by ingest."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.reader.finding.preview import preview
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

CAMPAIGN = """
schema: thermodata/campaign/1
id: c
machine: {id: m}
sources: {log: {reader: table, files: "{test}.csv", timezone: UTC}}
channels: {dZ: {source: log, signal: dZ, quantity: displacement, axis: Z, at: tcp%s}}
tests: [{id: V1, kind: spindle}]
"""


def write(folder: Path, name: str, row: str) -> None:
    lines = [f"2026-10-06 08:{k // 60:02d}:{k % 60:02d};{k / 1e5:.5f};{k * 10}" for k in range(300)]
    (folder / "V1.csv").write_text("\n".join([f"Zeit;{name};n [1/min]", row, *lines, ""]), encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "row", "asked"),
    [
        ("dZ [mm]", ";µm;1/min", ["dZ"]),
        ("dZ [mm]", ";mm;U/min", []),
        ("dZ_mm", ";um;1/s", ["dZ", "n"]),
        ("dZ [µm]", ";um;rpm", []),
    ],
)
def test_two_units_are_asked_and_none_is_written(tmp_path: Path, name: str, row: str, asked: list[str]) -> None:
    write(tmp_path, name, row)
    said = {c.name.partition("_")[0]: c.said for c in draft_files(tmp_path).draft.channels}
    assert [n for n, s in said.items() if any("as the name has it" in q for q in s.questions)] == asked
    assert [n for n, s in said.items() if s.unit is None] == asked
    told = [n for n in preview(tmp_path / "V1.csv")["notes"] if "and the file gives it in" in n]
    assert len(told) == len(asked)


@pytest.mark.parametrize(
    ("row", "declared", "told"),
    [
        (";µm;1/min", "", True),
        (";µm;1/min", ', unit: "µm"', False),
        (";µm;1/min", ', unit: mm, instead_of: "µm"', False),
        (";mm;1/min", "", False),
    ],
)
def test_ingest_tells_two_units_that_nobody_decided(tmp_path: Path, row: str, declared: str, told: bool) -> None:
    write(tmp_path, "dZ [mm]", row)
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN % declared, encoding="utf-8")
    summary = ingest(Store(tmp_path / "store", create=True), tmp_path / "campaign.yaml")
    assert any("'dZ [mm]' says mm, and the file gives it in µm" in str(x["reason"]) for x in summary.losses) == told


def test_ingest_tells_a_name_of_before_the_scaling_as_no_loss(tmp_path: Path) -> None:
    write(tmp_path, "dZ [V]", ";µm;1/min")
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN % "", encoding="utf-8")
    summary = ingest(Store(tmp_path / "store", create=True), tmp_path / "campaign.yaml")
    told = "'dZ [V]' says V, and the file gives it in µm"
    assert not any(told in str(x["reason"]) for x in summary.losses)
    assert any(told in note for note in summary.notes)
