"""A zone that is named by its places, as Windows names them: asked, with the zone that fits."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.plugin import Recording, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.preamble.zone_places import places_above, without_places

HOUR = 3600 * 10**9
EIGHT = 1772438400 * 10**9  # 2026-03-02 08:00 UTC
DATED = ["Zeit;T1 [°C]", *(f"2026-03-02 08:{k:02d}:00;{20 + k % 9},5" for k in range(40))]
COUNTED = ["Zeit [s];T1 [°C]", *(f"{60 * k};{20 + k % 9},5" for k in range(40))]


def described(folder: Path, head: str, rows: list[str], zone: str | None = None) -> Recording:
    (folder / "log.csv").write_text("\n".join(["Logger 7", head, *rows, ""]), "utf-8")
    source = Source(timezone=zone)
    return delimited.describe(delimited.open_table(folder / "log.csv", source), source)


@pytest.mark.parametrize(
    ("line", "zone"),
    [
        ("Zeitzone: (UTC+01:00) Amsterdam, Berlin, Bern", "Europe/Amsterdam"),
        ("Start: 2026-03-02 08:00:00 (UTC+01:00) Berlin", "Europe/Berlin"),
        ("Time zone: (UTC-06:00) Central Time, Chicago", "America/Chicago"),
        ("Time zone: (GMT+05:30) Chennai, Kolkata", "Asia/Kolkata"),
        ("Time zone: (UTC+10:00) Canberra, Sydney", "Australia/Canberra"),
        ("Time zone: (UTC-06:00) Central Time", "Etc/GMT+6"),
        ("Time zone: (UTC+01:00) London", "Etc/GMT-1"),  # not there
        ("Time zone: (UTC+05:30) Somewhere", None),
    ],
)
def test_the_zone_of_places(line: str, zone: str | None) -> None:
    assert places_above([[line]]) == (zone, line)


@pytest.mark.parametrize("line", ["Zeitzone: (UTC+01:00)", "Zeitzone: UTC+1", "Kanal (UTC+01:00) 3", "Berlin"])
def test_what_names_no_place(line: str) -> None:
    assert places_above([[line]]) is None
    assert without_places(line) == line


@pytest.mark.parametrize(
    ("head", "rows"),
    [("Zeitzone: (UTC+01:00) Berlin", DATED), ("Start time: 2026-03-02 08:00:00 (UTC+01:00) Berlin", COUNTED)],
    ids=["zone", "start"],
)
def test_it_is_asked_with_the_zone_that_fits(tmp_path: Path, head: str, rows: list[str]) -> None:
    found = described(tmp_path, head, rows)
    assert found.start_ns == EIGHT
    assert any(n.endswith("timezone: Europe/Berlin where they are") for n in found.notes)
    draft_files(tmp_path)
    (line,) = [x for x in (tmp_path / "campaign.yaml").read_text().splitlines() if "timezone?" in x]
    assert f"the head says '{head}'" in line
    declared = described(tmp_path, head, rows, "Europe/Berlin")
    assert declared.start_ns == EIGHT - HOUR
    assert not any("put ahead" in n or "is used" in n for n in declared.notes)


@pytest.mark.parametrize(("zone", "told"), [("Europe/London", True), ("Europe/Prague", False)])
def test_a_declared_zone_of_another_offset_is_told(tmp_path: Path, zone: str, told: bool) -> None:
    notes = described(tmp_path, "Zeitzone: (UTC+01:00) Berlin", DATED, zone).notes
    assert any(f"the declared {zone} is used" in n for n in notes) is told
