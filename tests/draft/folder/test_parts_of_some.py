"""A recording that was started anew in one test only: its parts have numbers, the files of other tests have none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.draft.make import draft_files


def write(folder: Path, name: str, start: str, rows: int) -> None:
    head = [f"T0:\t{start}", "", "Zeit [s]\tWeg Z [um]"]
    values = "\n".join([*head, *(f"{5 * i}.0\t{np.sin(i / 99):.3f}" for i in range(rows)), ""])
    (folder / name).write_text(values)


def test_parts_of_one_test_are_its_files_and_the_others_keep_theirs(tmp_path: Path) -> None:
    write(tmp_path, "V1_Weg.asc", "07.04.2026 08:00:00", 1200)
    write(tmp_path, "V2_Weg_1.asc", "08.04.2026 08:00:00", 600)
    write(tmp_path, "V2_Weg_2.asc", "08.04.2026 08:50:40", 600)
    write(tmp_path, "V3_Weg.asc", "09.04.2026 08:00:00", 1200)
    for test, day in (("V1", 7), ("V2", 8), ("V3", 9)):
        at = np.datetime64(f"2026-04-{day:02d}T08:00") + np.arange(0, 6000, 60).astype("timedelta64[s]")
        rows = "\n".join(["time;Hall air [degC]", *(f"{t};{20 + i / 400:.2f}" for i, t in enumerate(at)), ""])
        (tmp_path / f"{test}_air.csv").write_text(rows)
    draft = draft_files(tmp_path).draft
    assert [t.id for t in draft.tests] == ["V1", "V2", "V3"]
    assert {s.files for s in draft.sources} == {"{test}_Weg*.asc", "{test}_air.csv"}


def test_numbers_of_files_that_ran_at_once_are_none_of_parts(tmp_path: Path) -> None:
    for name in ("V1_Weg", "V2_Weg_1", "V2_Weg_2", "V3_Weg"):
        write(tmp_path, f"{name}.asc", f"0{6 + int(name[1])}.04.2026 08:00:00", 600)
    assert len(draft_files(tmp_path).draft.tests) == 4


@pytest.mark.parametrize(
    ("word", "start", "tests"),
    [
        ("Fortsetzung", "08:50:40", 3),
        ("cont", "08:50:40", 3),
        ("suite2", "08:50:40", 3),
        ("pokračování", "08:50:40", 3),
        ("Fortsetzung", "08:20:00", 4),  # began while the other ran
        ("Kontrolle", "08:50:40", 4),
    ],
)
def test_a_word_says_that_a_recording_goes_on(tmp_path: Path, word: str, start: str, tests: int) -> None:
    write(tmp_path, "P1_3000.asc", "07.04.2026 08:00:00", 1200)
    write(tmp_path, "P2_6000.asc", "08.04.2026 08:00:00", 600)
    write(tmp_path, f"P2_6000_{word}.asc", f"08.04.2026 {start}", 600)
    write(tmp_path, "P3_9000.asc", "09.04.2026 08:00:00", 1200)
    drafted = draft_files(tmp_path).draft.tests
    assert len(drafted) == tests
    if tests == 3:
        assert [t.id for t in drafted] == ["P1_3000", "P2_6000", "P3_9000"]


def seconds(folder: Path, name: str, begin_s: float, rows: int = 120) -> None:
    """A log without a date, 10 s from row to row."""
    values = [f"{begin_s + 10 * i:.1f},{20 + (begin_s + 10 * i) / 900:.3f}" for i in range(rows)]
    (folder / name).write_text("\n".join(["t [s],T_bed [degC]", *values, ""]))


def test_times_that_go_on_where_the_file_before_ended_make_one_test(tmp_path: Path) -> None:
    for k in range(3):
        seconds(tmp_path, f"V1_{k + 9}.csv", 1200.1 * k)
    draft = draft_files(tmp_path).draft
    assert [t.id for t in draft.tests] == ["V1"]
    assert draft.sources[0].files == "{test}_*.csv"
    assert (
        "log: 1 test in parts, e.g. V1 in 3 files: the times of each go on where those of the one before ended"
        in draft.notes
    )


@pytest.mark.parametrize(("pause_s", "tests"), [(290.0, 1), (310.0, 2)])
def test_parts_follow_each_other_within_a_quarter_of_their_length(tmp_path: Path, pause_s: float, tests: int) -> None:
    seconds(tmp_path, "V1_1.csv", 0.0, 121)
    seconds(tmp_path, "V1_2.csv", 1200.0 + pause_s)
    assert len(draft_files(tmp_path).draft.tests) == tests


def test_files_that_each_count_from_their_own_start_stay_tests(tmp_path: Path) -> None:
    for name, begin_s in (("V1_1", 0.0), ("V1_2", 1200.0), ("V2_1", 0.0), ("V2_2", 0.0)):
        seconds(tmp_path, f"{name}.csv", begin_s)
    draft = draft_files(tmp_path).draft
    assert len(draft.tests) == 4
    assert not any("in parts" in n for n in draft.notes)


@pytest.mark.parametrize(
    ("name", "start", "asked"),
    [
        ("M-2_2", "09:04:00", True),  # a quarter of an hour after it ended
        ("M-2_2", "13:00:00", False),
        ("M-2_2", "08:20:00", False),  # while it ran
        ("M-22", "09:04:00", False),
    ],
)
def test_a_number_behind_a_name_may_be_a_part_of_it(tmp_path: Path, name: str, start: str, asked: bool) -> None:
    write(tmp_path, "M-1.asc", "07.04.2026 08:00:00", 1200)
    write(tmp_path, "M-2.asc", "08.04.2026 08:00:00", 600)
    write(tmp_path, f"{name}.asc", f"08.04.2026 {start}", 300)
    write(tmp_path, "M-3.asc", "09.04.2026 08:00:00", 1200)
    draft_files(tmp_path)
    lines = [x for x in (tmp_path / "campaign.yaml").read_text("utf-8").splitlines() if "does it go on 'M-2'" in x]
    assert [f"id: {name}," in line for line in lines] == ([True] if asked else [])
