"""A zone that a head names and that leaves open where the times stand in summer: asked, and told where another is
declared; never taken in silence."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import draft_files
from thermodata.errors import QuestionError
from thermodata.plugin import Recording, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.tables.find_table import open_table
from thermodata.reader.text.tables.sample.zone_named import named_in, saving_on

HOUR = 3600 * 10**9
EIGHT = 1772438400 * 10**9  # 2026-03-02 08:00 UTC


def described(
    folder: Path, *, time: str = "Zeit", above: str = "", month: int = 3, zone: str | None = None
) -> Recording:
    rows = [f"2026-{month:02d}-02 08:{k:02d}:00;{20 + k % 9},5" for k in range(40)]
    lines = [*above.splitlines(), f"{time};T1 [°C]", *rows]
    (folder / "log.csv").write_text("\n".join([*lines, ""]), "utf-8")
    source = Source(timezone=zone)
    return delimited.describe(delimited.open_table(folder / "log.csv", source), source)


@pytest.mark.parametrize(
    ("header", "zone"),
    [
        ("Zeit (MEZ)", "Etc/GMT-1"),
        ("Time [EST]", "Etc/GMT+5"),
        ("Time, CEST", "Etc/GMT-2"),
        ("time_MESZ", "Etc/GMT-2"),
        ("Time (WET)", "UTC"),
        ("Time (UTC)", None),  # is taken
        ("time_est", None),
        ("CETTime", None),
        ("Time (CST)", None),
        ("Zeit", None),
    ],
)
def test_words_of_zones_in_headers(header: str, zone: str | None) -> None:
    assert (named_in([header]) or (None,))[0] == zone


def test_without_a_declared_zone_it_is_asked(tmp_path: Path) -> None:
    found = described(tmp_path, time="Zeit (MEZ)")
    assert found.start_ns == EIGHT
    assert any("no time zone" in n for n in found.notes)
    assert any("'Zeit (MEZ)'" in n and "timezone: Etc/GMT-1 where they never are" in n for n in found.notes)
    draft_files(tmp_path)
    (line,) = [x for x in (tmp_path / "campaign.yaml").read_text().splitlines() if "timezone?" in x]
    assert "the head says 'Zeit (MEZ)'" in line


@pytest.mark.parametrize(
    ("month", "zone", "told"), [(7, "Europe/Berlin", True), (3, "Europe/Berlin", False), (7, "Etc/GMT-1", False)]
)
def test_a_declared_zone_that_stands_elsewhere_is_told(tmp_path: Path, month: int, zone: str, told: bool) -> None:
    notes = described(tmp_path, time="Zeit (MEZ)", month=month, zone=zone).notes
    assert any(f"'Zeit (MEZ)'; the declared {zone} is used" in n for n in notes) is told
    assert not any("where they never are" in n for n in notes)


@pytest.mark.parametrize("line", ["Daylight saving;On", "DST: Yes", "# Sommerzeit = ein", "DST;1"])
def test_an_offset_beside_daylight_saving_is_asked(tmp_path: Path, line: str) -> None:
    found = described(tmp_path, above=f"UTC offset;+01:00\n{line}", month=3)
    assert found.start_ns == EIGHT
    assert any("no time zone" in n for n in found.notes)
    assert any("timezone: Etc/GMT-1 where they never are" in n for n in found.notes)


@pytest.mark.parametrize("line", ["Daylight saving;Off", "DST: No", "DST correction: On", "Interval;On"])
def test_an_offset_beside_none_is_taken(tmp_path: Path, line: str) -> None:
    assert described(tmp_path, above=f"UTC offset;+01:00\n{line}").start_ns == EIGHT - HOUR


def test_which_line_says_that_clocks_are_put_ahead() -> None:
    assert saving_on([["UTC offset", "+01:00"], ["Daylight saving", "On"]]) == "Daylight saving On"
    assert saving_on([["DST", "Off"]]) is None


@pytest.mark.parametrize(
    ("line", "zone"),
    [("# Time zone: America/New_York", "America/New_York"), ("Local time: Europe/Berlin", "Europe/Berlin")],
)
def test_a_zone_that_a_head_names_is_proposed_and_told_beside_another(tmp_path: Path, line: str, zone: str) -> None:
    described(tmp_path, time="Time", above=line)
    draft_files(tmp_path)
    (asked,) = [x for x in (tmp_path / "campaign.yaml").read_text().splitlines() if "timezone?" in x]
    assert f"timezone: {zone}?" in asked
    assert "Europe/Prague" not in asked
    told = described(tmp_path, time="Time", above=line, zone="Asia/Tokyo")
    assert any("the declared Asia/Tokyo is used" in note for note in told.notes)
    assert not any("says" in note for note in described(tmp_path, time="Time", above=line, zone=zone).notes)


@pytest.mark.parametrize("line", ["Path: Data/Berlin/log", "Unit: Pa/Hz", "Machine: Etc/None"])
def test_what_has_a_stroke_is_no_zone(tmp_path: Path, line: str) -> None:
    described(tmp_path, time="Time", above=line)
    draft_files(tmp_path)
    assert "e.g. timezone: Europe/Prague" in (tmp_path / "campaign.yaml").read_text()


@pytest.mark.parametrize(
    ("names", "zone"),
    [
        (["run1_UTC.csv"], "UTC"),
        (["run1_UTC+2.csv", "run2_UTC+2.csv"], "Etc/GMT-2"),
        (["run1_CET.csv"], "Etc/GMT-1"),
        (["run1_UTC.csv", "run2.csv"], "Europe/Prague"),
        (["run1.csv"], "Europe/Prague"),
    ],
)
def test_a_zone_in_the_names_of_all_files_is_proposed(tmp_path: Path, names: list[str], zone: str) -> None:
    for day, name in enumerate(names, 1):
        rows = [f"2026-03-{day:02d} 08:{k:02d}:00,{20 + k % 9}.5" for k in range(40)]
        (tmp_path / name).write_text("\n".join(["time,T1 [degC]", *rows, ""]))
    draft_files(tmp_path)
    (asked,) = [x for x in (tmp_path / "campaign.yaml").read_text().splitlines() if "timezone?" in x]
    assert f"timezone: {zone}" in asked


@pytest.mark.parametrize(("word", "zone"), [("HKT", "Asia/Hong_Kong"), ("XYZT", "Area/City, as Europe/Prague,")])
def test_a_word_behind_the_times_is_asked_with_its_zone_where_it_has_one(tmp_path: Path, word: str, zone: str) -> None:
    rows = [f"2026-06-15 17:58:{k:02d} {word};{20 + k / 8}" for k in range(40)]
    (tmp_path / "log.csv").write_text("\n".join(["Time;T_bed [degC]", *rows, ""]))
    with pytest.raises(QuestionError, match=f"an unknown zone '{word}'") as asked:
        open_table(tmp_path / "log.csv", Source())
    assert f"write timezone: {zone} into" in (asked.value.ask or "")
