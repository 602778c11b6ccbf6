"""What is asked of the zone of local times beside a source in UTC: what is known of it, and no more."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
import yaml

from thermodata.draft.make import draft_files

BEGAN = datetime(2026, 11, 26, 5, tzinfo=UTC)


def asked(folder: Path, hours: int, time: str = "Zeit", back_at: int = 999, began: datetime = BEGAN) -> str:
    """The question of the zone of times that are so many hours ahead, and an hour less from a row on."""
    rows = [began + timedelta(minutes=k) for k in range(200)]
    local = [t + timedelta(hours=hours - (k >= back_at)) for k, t in enumerate(rows)]
    lines = [f"{t:%d.%m.%Y %H:%M:%S};{20 + k / 50:.2f}" for k, t in enumerate(local)]
    (folder / "shop.csv").write_text("\n".join([f"{time};T_Spindel [°C]", *lines, ""]))
    utc = [f"{t:%Y-%m-%dT%H:%M:%SZ},{k / 10:.2f}" for k, t in enumerate(rows)]
    (folder / "probe_utc.csv").write_text("\n".join(["time_utc,disp_z_um", *utc, ""]))
    draft = draft_files(folder).draft
    return next(q for s in draft.sources for q in s.questions if q.startswith("timezone?"))


def test_an_offset_alone_tells_no_zone(tmp_path: Path) -> None:
    said = asked(tmp_path, 2)
    assert "+2 h from the other sources' UTC: so are Europe/Helsinki and others" in said
    assert "fits" not in said


def test_the_zone_that_the_file_names_is_proposed_where_it_fits(tmp_path: Path) -> None:
    said = asked(tmp_path, 1, "Zeit (MEZ)")
    assert "+1 h from the other sources' UTC, as those of Etc/GMT-1 are" in said
    assert "timezone: Etc/GMT-1?" in said


def test_and_told_of_where_it_does_not(tmp_path: Path) -> None:
    said = asked(tmp_path, 2, "Zeit (MEZ)")
    assert "those of Etc/GMT-1 were +1 h ahead then: was the clock set otherwise?" in said
    assert "Helsinki" not in said


def test_a_clock_that_is_set_back_tells_no_zone(tmp_path: Path) -> None:
    said = asked(tmp_path, 2, back_at=140)
    assert "its clock is set back later, so that they tell no zone" in said
    assert "Europe" not in said


def test_one_that_is_set_back_where_summer_time_ends_still_has_its_zones(tmp_path: Path) -> None:
    said = asked(tmp_path, 2, back_at=60, began=datetime(2026, 10, 25, 0, tzinfo=UTC))
    assert "+2 h from the other sources' UTC: so are Europe/Prague, Europe/Berlin and others" in said


@pytest.mark.parametrize("hours", [-9, 6, 13])
def test_hours_of_rare_zones_may_be_of_a_clock(tmp_path: Path, hours: int) -> None:
    assert "of what zone, or is the clock wrong by whole hours?" in asked(tmp_path, hours)


@pytest.mark.parametrize(
    ("declared", "kept"),
    [("Europe/Helsinki", True), ("Europe/Berlin", False), ("nowhere", False), ("", False)],
)
def test_a_draft_made_anew_keeps_the_zone_that_was_declared_and_fits(tmp_path: Path, declared: str, kept: bool) -> None:
    asked(tmp_path, 2)
    path = tmp_path / "campaign.yaml"
    path.write_text(path.read_text().replace("reader: cnc", f"reader: cnc, timezone: {declared}" if declared else ""))
    draft = draft_files(tmp_path, force=True).draft
    assert [s.timezone for s in draft.sources if s.timezone] == (["Europe/Helsinki"] if kept else [])
    assert any(q.startswith("timezone?") for s in draft.sources for q in s.questions) is not kept
    assert ("timezone: Europe/Helsinki}" in path.read_text()) is kept


@pytest.mark.parametrize(("hours", "local"), [(0, False), (2, True)])
def test_local_times_are_aligned_to_what_has_utc_whichever_has_the_probes(
    tmp_path: Path, hours: int, local: bool
) -> None:
    rows = [BEGAN + timedelta(seconds=20 * k) for k in range(400)]
    speeds = [3000 * (k // 60 % 2) + k // 90 * 500 for k in range(400)]
    ends = "" if local else "Z"
    probe = [
        f"{t + timedelta(hours=hours):%Y-%m-%d %H:%M:%S}{ends},{s},{s / 9}" for t, s in zip(rows, speeds, strict=True)
    ]
    other = [f"{t:%Y-%m-%d %H:%M:%S}Z,{s},{20 + s / 900}" for t, s in zip(rows, speeds, strict=True)]
    (tmp_path / "a_probe.csv").write_text("\n".join(["time,speed [rpm],disp_z [um]", *probe, ""]))
    (tmp_path / "a_ctrl.csv").write_text("\n".join(["time,n [rpm],T_front [degC]", *other, ""]))
    (aligned,) = [str(s.files) for s in draft_files(tmp_path).draft.sources if s.align]
    assert aligned == ("a_probe.csv" if local else "a_ctrl.csv").replace("a_", "{test}_")


WINTER, SUMMER = datetime(2026, 1, 20, 5, tzinfo=UTC), datetime(2026, 6, 20, 5, tzinfo=UTC)


def over_a_year(folder: Path, hours: tuple[int, ...], words: tuple[str, ...], beside: bool = True) -> str:
    """The question of a control's zone whose logs of winter and summer are so many hours ahead."""
    for k, (ahead, word) in enumerate(zip(hours, words, strict=True), 1):
        rows = [(WINTER if k < 3 else SUMMER) + timedelta(days=k, minutes=i) for i in range(200)]
        local = (f"{t + timedelta(hours=ahead):%d.%m.%Y %H:%M:%S};{20 + i / 50:.2f}" for i, t in enumerate(rows))
        (folder / f"X{k}_ctrl.csv").write_text("\n".join([f"{word};T_Spindel [°C]", *local, ""]))
        utc = (f"{t:%Y-%m-%dT%H:%M:%SZ},{i / 10:.2f}" for i, t in enumerate(rows))
        if beside:
            (folder / f"X{k}_probe.txt").write_text("\n".join(["time_utc,disp_z_um", *utc, ""]))
    draft = draft_files(folder).draft
    return next(q for s in draft.sources for q in s.questions if q.startswith("timezone?"))


def test_logs_whose_zone_changed_are_named_with_the_day_from_which_on(tmp_path: Path) -> None:
    said = over_a_year(tmp_path, (1, 1, 2, 2), ("Zeit",) * 4)
    assert "local times, +1 h/+2 h from the other sources' UTC" in said
    assert "(+1 h in X1_ctrl.csv, X2_ctrl.csv; +2 h from 2026-06-23 on in X3_ctrl.csv, X4_ctrl.csv)" in said
    assert "so are Europe/Prague, Europe/Berlin and others" in said


def test_logs_of_one_offset_are_not_told_apart(tmp_path: Path) -> None:
    said = over_a_year(tmp_path, (1, 1, 1, 1), ("Zeit",) * 4)
    assert "local times, +1 h from the other sources' UTC" in said
    assert "X1_ctrl" not in said


def test_heads_that_name_another_zone_later_are_told_with_their_file(tmp_path: Path) -> None:
    said = over_a_year(tmp_path, (1, 1, 2, 2), ("Zeit (MEZ)", "Zeit (MEZ)", "Zeit (MESZ)", "Zeit (MESZ)"), beside=False)
    assert "'Zeit (MEZ)'" in said
    assert "; 'Zeit (MESZ)' in X3_ctrl.csv from 2026-06-23 on" in said


def of_two_clocks(folder: Path) -> None:
    """Logs of two computers, each in local times that nothing else tells."""
    for k in (1, 2):
        rows = [BEGAN + timedelta(days=k, seconds=20 * i) for i in range(90)]
        own = (f"{t:%Y-%m-%d %H:%M:%S},{20 + i / 90:.3f},{i}" for i, t in enumerate(rows))
        far = (f"{t - timedelta(hours=6):%Y-%m-%d %H:%M:%S};{i / 7:.3f}" for i, t in enumerate(rows))
        (folder / f"run{k}_ctrl.csv").write_text("\n".join(["time,T_front [degC],n [rpm]", *own, ""]))
        (folder / f"run{k}_probe.txt").write_text("\n".join(["time;disp_z [um]", *far, ""]))


def declare(path: Path, zones: dict[str, str]) -> None:
    """Writes zones into the sources whose files hold a word."""
    lines = []
    for line in path.read_text().splitlines():
        word = next((w for w in zones if w in line and "reader:" in line), None)
        lines.append(line if word is None else line.replace("{reader:", f"{{timezone: {zones[word]}, reader:"))
    path.write_text("\n".join(lines) + "\n")


@pytest.mark.parametrize("torn", [False, True])
def test_a_draft_made_anew_keeps_each_zone_that_was_declared(tmp_path: Path, torn: bool) -> None:
    of_two_clocks(tmp_path)
    draft_files(tmp_path)
    path = tmp_path / "campaign.yaml"
    declare(path, {"ctrl": "Europe/Prague", "probe": "America/Chicago"})
    if torn:
        path.write_text(path.read_text() + "  - {id: \n")
    draft = draft_files(tmp_path, force=True).draft
    assert {str(s.files): s.timezone for s in draft.sources} == {
        "{test}_ctrl.csv": "Europe/Prague",
        "{test}_probe.txt": "America/Chicago",
    }
    assert not any(q.startswith("timezone?") for s in draft.sources for q in s.questions)


def test_a_zone_of_one_source_is_not_taken_for_another(tmp_path: Path) -> None:
    of_two_clocks(tmp_path)
    draft_files(tmp_path)
    path = tmp_path / "campaign.yaml"
    declare(path, {"ctrl": "UTC"})
    sources = draft_files(tmp_path, force=True).draft.sources
    assert {str(s.files): s.timezone for s in sources} == {"{test}_ctrl.csv": "UTC", "{test}_probe.txt": None}
    (asked_of,) = [s for s in sources if any(q.startswith("timezone?") for q in s.questions)]
    assert asked_of.files == "{test}_probe.txt"


def test_a_clock_and_a_table_that_a_draft_made_anew_drops_are_asked_of(tmp_path: Path) -> None:
    of_two_clocks(tmp_path)
    draft_files(tmp_path)
    path = tmp_path / "campaign.yaml"
    declare(path, {"ctrl": "UTC, clock: {offset: 7 min}, table: {stands: [2], time: {column: unknown}}"})
    sources = draft_files(tmp_path, force=True).draft.sources
    asked_of = {str(s.files): q for s in sources for q in s.questions if "as in the campaign file before?" in q}
    assert list(asked_of) == ["{test}_ctrl.csv"]
    assert asked_of["{test}_ctrl.csv"].startswith("clock: {offset: 7 min}, table: {stands: [2]}, as in")


def test_a_zone_goes_with_the_files_whatever_their_source_is_called(tmp_path: Path) -> None:
    of_two_clocks(tmp_path)
    draft_files(tmp_path)
    path = tmp_path / "campaign.yaml"
    declare(path, {"ctrl": "Europe/Prague", "probe": "America/Chicago"})
    names = [str(s["name"]) for s in _sources(path)]
    text = path.read_text()
    for name, other in zip(names, ("mine", "yours"), strict=True):
        text = text.replace(f"  {name}: {{timezone", f"  {other}: {{timezone").replace(
            f"source: {name},", f"source: {other},"
        )
    path.write_text(text)
    draft = draft_files(tmp_path, force=True).draft
    assert {s.timezone for s in draft.sources} == {"Europe/Prague", "America/Chicago"}
    assert {str(s.files): s.timezone for s in draft.sources}["{test}_ctrl.csv"] == "Europe/Prague"


def test_a_source_whose_zone_was_never_declared_is_asked_with_those_of_the_others(tmp_path: Path) -> None:
    of_two_clocks(tmp_path)
    rows = [BEGAN + timedelta(days=1, seconds=60 * i) for i in range(90)]
    own = (f"{t:%d.%m.%Y %H:%M:%S}\t{18 + i / 90:.3f}" for i, t in enumerate(rows))
    draft_files(tmp_path)
    path = tmp_path / "campaign.yaml"
    declare(path, {"ctrl": "Europe/Prague", "probe": "America/Chicago"})
    (tmp_path / "run1_hall.dat").write_text("\n".join(["time\tT_hall [degC]", *own, ""]))
    draft = draft_files(tmp_path, force=True).draft
    (asked_of,) = [q for s in draft.sources for q in s.questions if q.startswith("timezone?")]
    assert "; the campaign file before declares " in asked_of
    assert "Europe/Prague of " in asked_of
    assert "America/Chicago of " in asked_of


def test_zones_of_a_torn_file_that_name_no_source_are_all_said_and_none_is_taken(tmp_path: Path) -> None:
    of_two_clocks(tmp_path)
    lines = (f"  {name}:\n    reader: cnc\n    timezone: {zone}" for name, zone in DECLARED.items())
    (tmp_path / "campaign.yaml").write_text("\n".join(["sources:", *lines, "tests:", "  - {id: ", ""]))
    draft = draft_files(tmp_path, force=True).draft
    assert [s.timezone for s in draft.sources] == [None, None]
    said = [q for s in draft.sources for q in s.questions if q.startswith("timezone?")]
    assert len(said) == 2
    assert all("; the campaign file before declares Europe/Prague, America/Chicago" in q for q in said)


DECLARED = {"ctrl": "Europe/Prague", "probe": "America/Chicago"}


def _sources(path: Path) -> list[dict[str, object]]:
    return [{"name": n, **s} for n, s in yaml.safe_load(path.read_text())["sources"].items()]
