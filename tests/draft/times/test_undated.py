"""A log without dates beside one that has them: what is asked of when it began."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

import numpy as np
import pytest

from thermodata.draft.files.described_file import described_files
from thermodata.draft.make import draft_files
from thermodata.plugin import Block, Head, Loss, Recording, Signal, Source
from thermodata.reader.text.preamble.begin import EITHER


def asked(folder: Path, earlier_s: int, *, dated: bool = True, time: str = "t [s]", first: int = 0) -> list[str]:
    """What a draft asks of 2 h of probes without dates, whose times begin at `first`, beside a log that began so much
    earlier and ended with them."""
    (folder / "raw").mkdir(parents=True)
    t = np.arange(0, 7200, 10)
    rows = "\n".join([f"{time},Disp Z [um]", *(f"{first + x},{np.sin(x / 999):.3f}" for x in t), ""])
    (folder / "raw" / "daq_one.csv").write_text(rows)
    at = np.datetime64("2026-06-01T13:00:00") + (np.arange(-earlier_s, 7200, 10)).astype("timedelta64[s]")
    air = "\n".join(["time,Hall air [degC]", *(f"{x}Z,{20 + i / 400:.2f}" for i, x in enumerate(at)), ""])
    if dated:
        (folder / "raw" / "hall_one.csv").write_text(air)
    made = draft_files(folder).draft
    return [q for s in made.sources for q in s.questions if "when did it begin?" in q]


@pytest.mark.parametrize(("earlier_s", "questions"), [(0, 0), (120, 0), (130, 1), (1800, 1)])
def test_when_a_log_without_dates_began_is_asked_where_it_is_not_as_long_as_the_others(
    tmp_path: Path, earlier_s: int, questions: int
) -> None:
    found = asked(tmp_path, earlier_s)
    assert len(found) == questions
    assert all("clock: {offset: 0 s} if they begin together" in q for q in found)


@pytest.mark.parametrize("time", ["t [s]", "uptime_s"])
def test_a_log_that_counts_from_elsewhere_began_with_the_others_by_an_offset(tmp_path: Path, time: str) -> None:
    """As a logger counts from when it was switched on: without it, its times lie that much late."""
    (found,) = asked(tmp_path, 0, time=time, first=7200)
    assert "its times begin at 2 h in one" in found
    assert "clock: {offset: -7200 s} if they begin together" in found
    assert "beside" not in found.partition("; clock")[0]  # no length of a period that nobody has said


@pytest.mark.parametrize(("earlier_s", "questions"), [(0, 0), (1800, 1)])
def test_when_a_trace_of_a_control_without_dates_began_is_asked(tmp_path: Path, earlier_s: int, questions: int) -> None:
    (tmp_path / "raw").mkdir()
    rows = (f"{t}.000,{3000 if t > 900 else 0}" for t in range(0, 7200, 10))
    trace = "\n".join(["Time,/Nck/!SD/nckServoDataActVelMot64 [u1; 5]", *rows, ""])
    (tmp_path / "raw" / "trace_one.csv").write_text(trace)
    at = np.datetime64("2026-06-01T13:00:00") + np.arange(-earlier_s, 7200, 10).astype("timedelta64[s]")
    air = "\n".join(["time,Hall air [degC]", *(f"{x}Z,{20 + i / 400:.2f}" for i, x in enumerate(at)), ""])
    (tmp_path / "raw" / "hall_one.csv").write_text(air)
    found = [q for s in draft_files(tmp_path).draft.sources for q in s.questions if "when did it begin?" in q]
    assert len(found) == questions


def test_of_a_log_beside_none_with_dates_nothing_is_asked(tmp_path: Path) -> None:
    assert asked(tmp_path, 1800, dated=False) == []


@pytest.mark.parametrize(
    ("line", "question", "declared"),
    [
        ("Start time: 2026-06-01 13:07:00", None, {}),
        ("Start time: 06/01/2026 13:07:00", "start: dmy or mdy?", {"time": {"start": "unknown"}}),
        ("Start (UTC): 2026-06-01 13:07:00", None, {}),
        ("Exported: 2026-06-02 09:00:00", "start: head or none?", {"time": {"start": "unknown"}}),
        ("Start: 2026-06-01 13:07:00 CST", "when did it begin? the head says", {"time": {"start": "unknown"}}),
    ],
)
def test_a_start_above_the_rows_is_taken_or_asked(
    tmp_path: Path, line: str, question: str | None, declared: dict[str, dict[str, str]]
) -> None:
    rows = "\n".join([line, "", "t [s],Disp Z [um]", *(f"{x},{x / 999:.3f}" for x in range(0, 7200, 10)), ""])
    (tmp_path / "daq_one.csv").write_text(rows)
    (source,) = draft_files(tmp_path).draft.sources
    assert source.table == declared
    assert [q for q in source.questions if "start:" in q] == [
        q for q in source.questions if q.startswith(question or "-")
    ]
    assert any("did it begin" in q or "timezone?" in q for q in source.questions) == (
        "Start" in line and "UTC" not in line
    )


@pytest.mark.parametrize(("day", "hint"), [("2026-06-01", "mdy"), ("2026-01-06", "dmy"), ("2026-09-09", "")])
def test_the_dates_of_another_source_say_which_order_fits(tmp_path: Path, day: str, hint: str) -> None:
    head = ["Start time: 06/01/2026 13:07:00", "", "t [s],Disp Z [um]"]
    rows = "\n".join([*head, *(f"{x},{x / 999:.3f}" for x in range(0, 7200, 10)), ""])
    (tmp_path / "one_daq.csv").write_text(rows)
    at = np.datetime64(f"{day}T13:00:00") + np.arange(0, 7200, 10).astype("timedelta64[s]")
    air = "\n".join(["time,Hall air [degC]", *(f"{x}Z,{20 + i / 400:.2f}" for i, x in enumerate(at)), ""])
    (tmp_path / "one_hall.csv").write_text(air)
    draft = draft_files(tmp_path).draft
    (asked,) = [q for s in draft.sources for q in s.questions if q.startswith("start:")]
    assert ("fits the dates of" in asked) == bool(hint)
    assert f"; {hint} fits" in asked or not hint


class Quoting:
    """A reader whose note holds what the file says, whatever is declared of it."""

    name = "quoting"

    def sniff(self, head: Head) -> str | None:
        return "all files"

    def describe(self, path: Path, source: Source) -> Recording:
        return Recording((Signal("T", "main", "degC"),), "relative", notes=(f"a column called '{EITHER}'",))

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        return iter(())


def test_a_file_that_speaks_as_a_note_on_its_start_is_asked_once(tmp_path: Path) -> None:
    """It held up a draft for ever."""
    (tmp_path / "log.txt").write_text("x")
    [found] = described_files(Quoting(), tmp_path / "log.txt", PurePosixPath("log.txt"))
    assert len(found.asked) == 1


@pytest.mark.parametrize(("first", "asks"), [("02:05", True), ("01:05", False), ("02:25", False), ("03:05", False)])
def test_local_times_within_the_hour_that_repeats_ask_which_pass(tmp_path: Path, first: str, asks: bool) -> None:
    at = np.datetime64(f"2026-10-25T{first}:00") + np.arange(90) * np.timedelta64(30, "s")
    (tmp_path / "one.csv").write_text("\n".join(["time;T [degC]", *(f"{x};{20 + i}" for i, x in enumerate(at)), ""]))
    (source,) = draft_files(tmp_path).draft.sources
    (asked,) = [q for q in source.questions if q.startswith("timezone?")]
    assert ("start: 2026-10-25T02:05:00+02:00 for the first pass, 2026-10-25T02:05:00+01:00" in asked) is asks


@pytest.mark.parametrize(
    ("logs", "said"),
    [
        ((("25T00:00", 150), ("25T02:05", 50), ("25T05:05", 50)), "in its second pass, as hall_1.csv before it says"),
        ((("25T01:00", 50), ("25T02:05", 50), ("25T02:00", 180)), "in its first pass, as hall_3.csv behind it says"),
        ((("25T01:00", 50), ("25T02:05", 50), ("25T03:05", 50)), "for the first pass, 2026-10-25T02:05:00+01:00"),
        ((("25T00:00", 240), ("25T02:05", 50), ("25T05:00", 50)), "for the first pass, 2026-10-25T02:05:00+01:00"),
        ((("24T00:00", 180), ("25T02:05", 50), ("26T02:00", 180)), "for the first pass, 2026-10-25T02:05:00+01:00"),
    ],
)
def test_other_logs_of_the_source_tell_the_pass_of_one_in_the_hour_that_repeats(
    tmp_path: Path, logs: tuple[tuple[str, int], ...], said: str
) -> None:
    """As those of a hall, in a folder of their own."""
    (tmp_path / "hall").mkdir()
    for i, (first, minutes) in enumerate(logs, 1):
        at = np.datetime64(f"2026-10-{first}:00") + np.arange(2 * minutes) * np.timedelta64(30, "s")
        values = (f"{x};{20 + k / 90:.2f};{19 + k / 99:.2f}" for k, x in enumerate(at))
        rows = ["time;T_hall [degC];T_floor [degC]", *values, ""]
        (tmp_path / "hall" / f"hall_{i}.csv").write_text("\n".join(rows))
    draft = draft_files(tmp_path).draft
    (asked,) = [q for s in draft.sources for q in s.questions if q.startswith("timezone?")]
    assert said in asked
    zone = "+01:00" if "second pass, as" in said else "+02:00"
    assert f"with it give the test its start: 2026-10-25T02:05:00{zone}" in asked


@pytest.mark.parametrize(
    "logs",
    [
        (("cool", "25T02:05", 25), ("later", "25T08:10", 40), ("warm", "25T02:10", 40)),
        (("cool", "25T02:05", 25), ("warm", "25T02:10", 40)),
        (("hall_1", "25T02:05", 25), ("hall_2", "25T08:10", 40), ("hall_3", "25T02:10", 40)),
        (("hall_1", "25T08:00", 25), ("hall_2", "25T02:05", 25), ("hall_3", "25T02:10", 40)),
    ],
)
def test_logs_that_names_do_not_order_tell_no_pass(tmp_path: Path, logs: tuple[tuple[str, str, int], ...]) -> None:
    for name, first, minutes in logs:
        at = np.datetime64(f"2026-10-{first}:00") + np.arange(2 * minutes) * np.timedelta64(30, "s")
        rows = ["time;T_hall [degC];T_floor [degC]", *(f"{x};{20 + k / 90:.2f};19.5" for k, x in enumerate(at)), ""]
        (tmp_path / f"{name}.csv").write_text("\n".join(rows))
    (asked,) = [q for s in draft_files(tmp_path).draft.sources for q in s.questions if q.startswith("timezone?")]
    assert "pass, as" not in asked
    assert "start: 2026-10-25T02:05:00+02:00 for the first pass, 2026-10-25T02:05:00+01:00 for the second" in asked


@pytest.mark.parametrize(
    ("parts", "asks"),
    [
        ((("25T00:00", 110), ("25T02:05", 40)), False),  # the start is of the part before
        ((("25T02:05", 55), ("25T03:00", 60)), True),
        ((("25T02:05", 20), ("25T02:25", 30)), True),
    ],
)
def test_which_pass_is_asked_of_a_file_that_begins_its_test(
    tmp_path: Path, parts: tuple[tuple[str, int], ...], asks: bool
) -> None:
    """The start of a test is of none that comes later: ingest would refuse it."""
    for test, spans in {"a1": parts, "b2": (("20T08:00", 120), ("20T10:00", 120))}.items():
        (tmp_path / test).mkdir()
        for i, (first, minutes) in enumerate(spans, 1):
            at = np.datetime64(f"2026-10-{first}:00") + np.arange(2 * minutes) * np.timedelta64(30, "s")
            rows = ["time;T [degC]", *(f"{x};{20 + k / 10}" for k, x in enumerate(at)), ""]
            (tmp_path / test / f"log_{i}.csv").write_text("\n".join(rows))
    draft = draft_files(tmp_path).draft
    (asked,) = [q for s in draft.sources for q in s.questions if q.startswith("timezone?")]
    assert ("start: 2026-10-25T02:05:00+02:00 for the first pass" in asked) is asks
    assert [t.id for t in draft.tests] == ["a1", "b2"]


@pytest.mark.parametrize(
    ("names", "heads", "said"),
    [
        (("hall_MESZ", "hall_MEZ"), ("", ""), ("first pass, as 'MESZ' says", "second pass, as 'MEZ' says")),
        (("a", "b"), ("# Sommerzeit\n", "# Winterzeit\n"), ("as 'Sommerzeit' says", "as 'Winterzeit' says")),
        (("a_CEST", "b"), ("", ""), ("first pass, as 'CEST' says", "for the first pass, 2026-10-25T02:05:00+01:00")),
        (("a_EST", "b"), ("", ""), ("a_EST.csv lie", "for the first pass, 2026-10-25T02:05:00+01:00")),
    ],
)
def test_words_tell_the_pass_of_logs_in_the_hour_that_repeats(
    tmp_path: Path, names: tuple[str, str], heads: tuple[str, str], said: tuple[str, str]
) -> None:
    at = np.datetime64("2026-10-25T02:05:00") + np.arange(90) * np.timedelta64(30, "s")
    rows = "\n".join(["time;T_hall [degC];T_floor [degC]", *(f"{x};{20 + k / 90:.2f};19.5" for k, x in enumerate(at))])
    for name, head in zip(names, heads, strict=True):
        (tmp_path / f"{name}.csv").write_text(f"{head}{rows}\n")
    (asked,) = [q for s in draft_files(tmp_path).draft.sources for q in s.questions if q.startswith("timezone?")]
    assert all(part in asked for part in said)


def test_the_zone_of_a_start_is_asked_once_and_kept(tmp_path: Path) -> None:
    rows = "\n".join(["t [s],{}", *(f"{10 * k},{20 + k / 90:.3f}" for k in range(90)), ""])
    for run in ("2026-04-14 08-30-00", "2026-04-15 09-00-00"):
        (tmp_path / run).mkdir()
        for name in ("T_bed [degC]", "T_hall [degC]"):
            (tmp_path / run / f"{name[:6].strip()}.txt").write_text(rows.replace("{}", name))

    def zones(force: bool) -> list[str]:
        sources = draft_files(tmp_path, force=force).draft.sources
        return [q for s in sources for q in s.questions if q.startswith("timezone?")]

    (found,) = zones(False)
    assert "the start of 2026-04-14 08-30-00 is a local time, and names no zone; taken as UTC" in found
    path = tmp_path / "campaign.yaml"
    path.write_text(
        re.sub(r"(timezone: )?}( +# \? timezone\?)", r", timezone: Europe/Prague}\2", path.read_text(), count=1)
    )
    assert zones(True) == []
    assert path.read_text().count("timezone: Europe/Prague}") == 1
