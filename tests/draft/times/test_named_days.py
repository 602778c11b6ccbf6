"""Times of day in a file whose name has the date: the start of its test, and the next day's
file that goes on with it."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.commands import Say


def _drafted(folder: Path, say: Say, files: dict[str, tuple[float, float]], date: str = "") -> list[dict[str, Any]]:
    """files: name -> from and to [h of a day]."""
    folder.mkdir(exist_ok=True)
    for name, (begin, end) in files.items():
        seconds = range(round(begin * 3600), round(end * 3600), 20)
        rows = [f"{date}{t // 3600:02d}:{t // 60 % 60:02d}:{t % 60:02d}\t{20 + t / 9e3:.3f}" for t in seconds]
        (folder / name).write_text("\n".join(["Time\tT_bed (C)", *rows, ""]), encoding="utf-8")
    assert say("init", folder).code == 0
    tests = yaml.safe_load((folder / "campaign.yaml").read_text(encoding="utf-8"))["tests"]
    return [{k: t.get(k) for k in ("id", "start", "files")} for t in tests]


@pytest.mark.parametrize("name", ["Thermo_{}.txt", "{}.txt", "log-{}.txt"])
def test_the_start_and_what_goes_on_behind_midnight(tmp_path: Path, say: Say, name: str) -> None:
    names = [name.format(f"202604{day:02d}") for day in (7, 8, 9)]
    files = {names[0]: (20.0, 24.0), names[1]: (0.0, 4.0), names[2]: (8.0, 13.0)}
    stem = [n.removesuffix(".txt") for n in names]
    assert _drafted(tmp_path, say, files) == [
        {"id": stem[0], "start": "2026-04-07 20:00:00", "files": {"log": names[:2]}},
        {"id": stem[2], "start": "2026-04-09 08:00:00", "files": {"log": names[2]}},
    ]


@pytest.mark.parametrize(
    ("first", "second"), [((8.0, 12.0), (0.0, 4.0)), ((20.0, 24.0), (0.5, 4.0)), ((20.0, 23.5), (0.0, 4.0))]
)
def test_what_does_not_go_on_stays_apart(
    tmp_path: Path, say: Say, first: tuple[float, float], second: tuple[float, float]
) -> None:
    found = _drafted(tmp_path, say, {"Thermo_20260407.txt": first, "Thermo_20260408.txt": second})
    assert [t["id"] for t in found] == ["Thermo_20260407", "Thermo_20260408"]
    assert all(t["start"] for t in found)


def test_rows_with_dates_and_names_without_say_no_start(tmp_path: Path, say: Say) -> None:
    dated = {"Thermo_20260407.txt": (8.0, 12.0), "Thermo_20260409.txt": (8.0, 12.0)}
    assert [t["start"] for t in _drafted(tmp_path / "dated", say, dated, "2026-04-07 ")] == [None, None]
    numbered = {"run_1.txt": (20.0, 24.0), "run_2.txt": (0.0, 4.0)}
    assert [t["start"] for t in _drafted(tmp_path / "numbered", say, numbered)] == [None, None]


def test_tests_of_other_names_stay_apart_though_one_ends_where_the_other_begins(tmp_path: Path, say: Say) -> None:
    files = {"S4000_20260407.txt": (20.0, 24.0), "S8000_20260408.txt": (0.0, 4.0)}
    found = _drafted(tmp_path, say, files)
    assert [t["id"] for t in found] == ["S4000_20260407", "S8000_20260408"]


def _daily(folder: Path, say: Say, files: dict[str, tuple[int, float, float]]) -> tuple[list[list[str]], str]:
    """(the files of each test; the draft). files: name -> day of April, and from and to [h] of that day, in UTC."""
    for name, (day, begin, end) in files.items():
        seconds = range(round(begin * 3600), round(end * 3600), 20)
        times = [datetime(2026, 4, day, tzinfo=UTC) + timedelta(seconds=t) for t in seconds]
        column = "T_hall" if name.startswith("hall") else "T_bed"
        rows = [f"{t:%Y-%m-%dT%H:%M:%SZ},{20 + k % 997 / 300:.3f}" for k, t in enumerate(times)]
        (folder / name).write_text("\n".join([f"time,{column} [degC]", *rows, ""]), encoding="utf-8")
    assert say("init", folder).code == 0
    text = (folder / "campaign.yaml").read_text(encoding="utf-8")
    drafted = yaml.safe_load(text)
    own = [t.get("files") or {"log": f"{t['id']}.csv"} for t in drafted["tests"]]
    return [[f for some in o.values() for f in ([some] if isinstance(some, str) else some)] for o in own], text


NAMES = [f"Thermo_202604{day:02d}.csv" for day in (7, 8, 9)]


def test_a_file_a_day_of_one_recording_is_one_test_though_its_rows_have_dates(tmp_path: Path, say: Say) -> None:
    tests, text = _daily(tmp_path, say, dict(zip(NAMES, [(7, 20, 24), (8, 0, 24), (9, 0, 4)], strict=True)))
    assert tests == [NAMES]
    assert f"Thermo_20260407 goes on without a gap in {NAMES[1]}, {NAMES[2]}" in text


def test_a_day_that_ends_by_local_time_goes_on_too(tmp_path: Path, say: Say) -> None:
    tests, _ = _daily(tmp_path, say, dict(zip(NAMES, [(7, 12, 22), (7, 22, 46), (8, 22, 30)], strict=True)))
    assert tests == [NAMES]


@pytest.mark.parametrize(
    "files",
    [
        {NAMES[0]: (7, 8, 18), NAMES[1]: (8, 8, 18)},
        {NAMES[0]: (7, 8, 24), NAMES[1]: (8, 0.1, 18)},
        {NAMES[0]: (7, 8, 24.1), NAMES[1]: (8, 0, 18)},
        {"S4000_20260407.csv": (7, 8, 24), "S8000_20260408.csv": (8, 0, 18)},
        {NAMES[0]: (7, 8, 12), NAMES[2]: (7, 12, 18)},
    ],
    ids=["a night", "a gap", "an overlap", "another name", "days apart by their names"],
)
def test_what_does_not_go_on_by_its_rows_and_its_name_stays_apart(
    tmp_path: Path, say: Say, files: dict[str, tuple[int, float, float]]
) -> None:
    tests, text = _daily(tmp_path, say, files)
    assert [len(t) for t in tests] == [1, 1]
    assert "goes on" not in text


def test_of_several_sources_all_go_on_or_none_does(tmp_path: Path, say: Say) -> None:
    bed = {"bed_20260407.csv": (7, 20.0, 24.0), "bed_20260408.csv": (8, 0.0, 4.0)}
    hall = {"hall_20260407.csv": (7, 20.0, 24.0), "hall_20260408.csv": (8, 0.0, 4.0)}
    (tmp_path / "both").mkdir()
    tests, _ = _daily(tmp_path / "both", say, {**bed, **hall})
    assert [sorted(t) for t in tests] == [sorted({**bed, **hall})]
    (tmp_path / "one").mkdir()
    tests, _ = _daily(tmp_path / "one", say, {**bed, **hall, "hall_20260408.csv": (8, 1.0, 4.0)})
    assert len(tests) == 2


def test_two_recordings_one_after_the_other_are_two_tests(tmp_path: Path, say: Say) -> None:
    alt = {"alt_20260407.csv": (7, 20.0, 24.0), "alt_20260408.csv": (8, 0.0, 4.0)}
    neu = {"neu_20260408.csv": (8, 4.0, 24.0), "neu_20260409.csv": (9, 0.0, 4.0)}
    tests, _ = _daily(tmp_path, say, {**alt, **neu})
    assert sorted(sorted(t) for t in tests) == [sorted(alt), sorted(neu)]


@pytest.mark.parametrize(("second_day", "tests"), [("13", 2), ("15", 3)])
def test_parts_that_a_folder_joins_are_not_asked_for_a_pause_that_their_names_tell(
    tmp_path: Path, say: Say, second_day: str, tests: int
) -> None:
    """As an ingest joins them: at the next of their times of day. Days more between them, and they are no one test."""
    for k in range(2):
        (tmp_path / f"a{k}").mkdir()
        days = ("12", second_day) if k == 0 else ("20", "21")
        for day, first in zip(days, (22, 0), strict=True):
            rows = [f"{first + i // 60:02d}:{i % 60:02d}:00;{20 + k + i / 99:.2f}" for i in range(120)]
            (tmp_path / f"a{k}" / f"log_202605{day}.csv").write_text("\n".join(["Uhrzeit;T_Lager [degC]", *rows, ""]))
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text()
    assert (text.count("  - {id:"), "nothing dates them" in text) == (tests, False)
