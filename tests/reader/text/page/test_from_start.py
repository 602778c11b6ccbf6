"""Numbers that count from a midnight or from when a logger was switched on, below a line that says which."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from tests.draft.labs import workbook
from thermodata.draft.make import draft_files
from thermodata.errors import QuestionError
from thermodata.plugin import Block, Source
from thermodata.reader.contract.guard import described, guarded
from thermodata.reader.finding.registry import readers

AT = datetime(2026, 3, 9, 23, 50, tzinfo=UTC)
TIMES = [AT + timedelta(seconds=30 * k) for k in range(40)]  # over midnight
NS = [int(t.timestamp()) * 10**9 for t in TIMES]
BOOT = datetime(2026, 3, 9, 5, 47, 12, tzinfo=UTC)
MILLIS = [round((t - BOOT).total_seconds() * 1000) for t in TIMES]


def of_day(moment: datetime, begun: datetime = AT) -> float:
    return (moment - moment.replace(hour=0, minute=0, second=0)).total_seconds()


def written(folder: Path, head: list[str], columns: dict[str, list[Any]], ext: str = "csv") -> Path:
    path = folder / f"run.{ext}"
    columns = {**columns, "T [degC]": [20 + k / 10 for k in range(40)]}
    rows = [list(r) for r in zip(*columns.values(), strict=True)]
    if ext == "xlsx":
        workbook(path, {"log": [*([line] for line in head), list(columns), *rows]})
    else:
        path.write_text("\n".join([*head, ";".join(columns), *(";".join(map(str, r)) for r in rows), ""]))
    return path


def times(path: Path, **time: object) -> list[int] | None:
    source = Source(timezone="UTC", table={"time": time} if time else None)
    reader = readers()["table"]
    recording = described(reader, path, source)
    if recording.clock == "relative":
        return None
    return [int(t) for b in guarded(reader, path, source, recording) if isinstance(b, Block) for t in b.t_ns]


@pytest.mark.parametrize("ext", ["csv", "xlsx"])
@pytest.mark.parametrize(
    ("head", "name", "scale"),
    [
        (["Date: 2026-03-09", "Timezone: UTC"], "Seconds since midnight", 1),
        (["Datum: 09.03.2026"], "Sekunden seit Mitternacht", 1),
        (["Date: 2026-03-09"], "ms_since_midnight", 1000),
        (["Date: 2026-03-09"], "second of day", 1),
    ],
)
def test_seconds_since_midnight_are_times_of_the_day_above_them(
    tmp_path: Path, head: list[str], name: str, scale: int, ext: str
) -> None:
    path = written(tmp_path, head, {name: [of_day(t) * scale for t in TIMES]}, ext)
    assert times(path) == NS
    notes = described(readers()["table"], path, Source(timezone="UTC")).notes
    assert any("times of day are of the date that stands above the rows" in n and head[0] in n for n in notes)
    (source,) = draft_files(tmp_path).draft.sources
    assert not [q for q in source.questions if not q.startswith("timezone?")]


def test_they_may_run_on_behind_midnight(tmp_path: Path) -> None:
    counts = [of_day(AT) + 30 * k for k in range(40)]
    assert times(written(tmp_path, ["Date: 2026-03-09"], {"seconds_since_midnight": counts})) == NS


@pytest.mark.parametrize("ext", ["csv", "xlsx"])
def test_they_may_stand_beside_their_day(tmp_path: Path, ext: str) -> None:
    days = {"Date": [f"{t:%Y-%m-%d}" for t in TIMES], "Seconds since midnight": [of_day(t) for t in TIMES]}
    assert times(written(tmp_path, [], days, ext)) == NS


@pytest.mark.parametrize("ext", ["csv", "xlsx"])
@pytest.mark.parametrize("last", [False, True])
def test_their_day_may_be_the_same_in_all_rows(tmp_path: Path, ext: str, last: bool) -> None:
    begun = datetime(2026, 3, 9, 8, tzinfo=UTC)
    moments = [begun + timedelta(seconds=30 * k) for k in range(40)]
    day, counts = [f"{t:%Y-%m-%d}" for t in moments], [of_day(t) for t in moments]
    columns = {"date": day, **({"T [degC]": []} if last else {}), "seconds_since_midnight": counts}
    path = written(tmp_path, [], columns, ext)
    assert times(path) == [int(t.timestamp()) * 10**9 for t in moments]
    assert [s.name for s in described(readers()["table"], path, Source(timezone="UTC")).signals] == ["T [degC]"]


def test_without_a_day_they_are_times_of_day(tmp_path: Path) -> None:
    path = written(tmp_path, [], {"seconds_since_midnight": [of_day(t) for t in TIMES]})
    recording = described(readers()["table"], path, Source())
    assert recording.clock == "relative"
    assert any("times of day without a date" in n for n in recording.notes)


@pytest.mark.parametrize("name", ["hour_of_day", "seconds since start", "midnight_load [s]"])
def test_the_nearest_other_names_beside_a_time_are_signals(tmp_path: Path, name: str) -> None:
    columns = {"time": [f"{t:%Y-%m-%d %H:%M:%S}" for t in TIMES], name: [of_day(t) for t in TIMES]}
    path = written(tmp_path, ["Date: 2026-03-09"], columns)
    assert times(path) == NS
    assert name in [s.name for s in described(readers()["table"], path, Source()).signals]


@pytest.mark.parametrize("name", ["millis", "millis()", "uptime_ms", "ms_since_boot", "ms"])
@pytest.mark.parametrize("ext", ["csv", "xlsx"])
def test_a_counter_below_the_moment_of_its_start_is_asked_with_it(tmp_path: Path, name: str, ext: str) -> None:
    path = written(tmp_path, ["# ESP32 node", "# boot at 2026-03-09T05:47:12Z"], {name: MILLIS}, ext)
    with pytest.raises(QuestionError) as asked:
        times(path)
    assert "boot at: 2026-03-09T05:47:12Z" in asked.value.ask
    assert "2026-03-09 23:50:00 UTC" in asked.value.ask
    assert times(path, **asked.value.declare["time"]) == NS
    (source,) = draft_files(tmp_path).draft.sources
    assert source.table == asked.value.declare


def test_a_time_below_the_moment_of_its_start_is_asked_whether_it_counts_from_there(tmp_path: Path) -> None:
    path = written(tmp_path, ["# boot at 2026-03-09T05:47:12Z"], {"uptime [ms]": MILLIS})
    assert times(path) is None
    (source,) = draft_files(tmp_path).draft.sources
    assert any("boot at: 2026-03-09T05:47:12Z" in q for q in source.questions)
    assert times(path, start="head") == NS


def test_another_moment_above_a_counter_is_not_proposed(tmp_path: Path) -> None:
    path = written(tmp_path, ["# calibrated at 2026-03-09T05:47:12Z"], {"millis": MILLIS})
    with pytest.raises(QuestionError) as asked:
        times(path)
    assert "calibrated" not in asked.value.ask
    assert asked.value.declare == {"time": {"period": "unknown"}}


@pytest.mark.parametrize("ext", ["csv", "xlsx"])
@pytest.mark.parametrize(
    "line", ["boot: 2026-02-20 06:00:00", "Neustart: 20.02.2026 06:00:00", "Test boot: 2026-02-20 06:00:00"]
)
def test_when_a_logger_was_switched_on_dates_no_rows_that_nobody_declares(tmp_path: Path, line: str, ext: str) -> None:
    path = written(tmp_path, [line], {"time [min]": list(range(40))}, ext)
    assert times(path) is None
    notes = described(readers()["table"], path, Source()).notes
    assert any(line in n and "not taken for the start" in n for n in notes)
    booted = int(datetime(2026, 2, 20, 6, tzinfo=UTC).timestamp()) * 10**9
    assert times(path, start="head") == [booted + 60 * 10**9 * k for k in range(40)]
    assert times(path, start="none") is None


def test_who_declines_the_moment_of_a_boot_gets_no_dates(tmp_path: Path) -> None:
    path = written(tmp_path, ["# boot at 2026-03-09T05:47:12Z"], {"millis": [1000 * k for k in range(5, 45)]})
    with pytest.raises(QuestionError, match="millis") as asked:
        times(path)
    assert "else time: {column: 1, unit: ms}" in asked.value.ask
    assert times(path, column=1, unit="ms") is None


def test_a_date_beside_a_boot_is_that_of_times_of_day_below(tmp_path: Path) -> None:
    head = ["Date: 2026-03-09", "boot: 2026-02-20 06:00:00"]
    path = written(tmp_path, head, {"time": [f"{t:%H:%M:%S}" for t in TIMES[:20]] * 2})
    recording = described(readers()["table"], path, Source(timezone="UTC"))
    assert any("Date: 2026-03-09" in n for n in recording.notes)
    assert not any("boot" in n for n in recording.notes)
