"""A file that was copied in its folder is left out of a draft, and said; equal logs of two tests are not."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path, PurePosixPath

import numpy as np
import pytest

from tests.commands import Said
from thermodata.draft.folder.put_aside.file_copies import beginnings_in, copies_in
from thermodata.draft.make import draft_files

LOG = "time [s];T_front [degC]\n" + "".join(f"{i};{20 + i / 10:.1f}\n" for i in range(60))


@pytest.mark.parametrize(
    ("original", "copy", "is_one"),
    [
        ("day 2 数控.csv", "day 2 数控 - 副本.csv", True),
        ("run1.csv", "run1 (2).csv", True),
        ("run1.csv", "Kopie von run1.csv", True),
        ("run1.csv", "run1_copy.csv", True),
        ("run1.csv", "run12.csv", False),
        ("run1.csv", "run2.csv", False),
        ("run1.csv", "run1_b.csv", False),
        ("run1.csv", "run1 copy.txt", False),
        ("a/run1.csv", "b/run1 copy.csv", False),
        ("run1.csv", "run1.1.csv", False),
        ("run1.csv", "backup/run1.csv", True),
        ("run1.csv", "run1.csv.bak", True),
        ("run1.csv", "day2/run1.csv", False),
        ("T1/T1.tdms", "backup/T1.tdms", True),
        ("a1/log.csv", "old/a1/log.csv", True),
        ("data/a1/log.csv", "Sicherung 2026-05-01/a1/log.csv", True),
        ("a1/log.csv", "a1 - Copy/log.csv", True),
        ("a1/log.csv", "Kopie von a1/log.csv", True),
        ("a1/log.csv", "a1 (2)/log.csv", True),
        ("a1/hall.csv", "a2/hall.csv", False),
        ("a1/hall.csv", "a1 warm/hall.csv", False),
        ("a1/hall.csv", "a12/hall.csv", False),
        ("old/a1/hall.csv", "old/a2/hall.csv", False),
    ],
)
def test_a_copy_is_told_by_its_name_and_its_bytes(tmp_path: Path, original: str, copy: str, is_one: bool) -> None:
    paths = [PurePosixPath(p) for p in (copy, original)]
    for path in paths:
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(LOG)
    assert copies_in(tmp_path, paths) == ({paths[0]: paths[1]} if is_one else {})
    (tmp_path / copy).write_text(LOG.replace("20.0", "20.1"))
    assert copies_in(tmp_path, paths) == {}


def test_a_draft_keeps_the_original_and_names_the_copy(tmp_path: Path, say: Callable[..., Said]) -> None:
    for i in (1, 2, 3):
        (tmp_path / f"day {i}.csv").write_text(LOG.replace("20.0", f"2{i}.0"))
    (tmp_path / "day 2 - Kopie.csv").write_text(LOG.replace("20.0", "22.0"))
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text()
    assert text.count("  - {id:") == 3
    assert "# not used: day 2 - Kopie.csv: a copy of day 2.csv: their bytes are equal" in text


@pytest.mark.parametrize(
    ("short", "long", "is_one"),
    [
        ("R1_backup.csv", "R1.csv", True),
        ("R1.csv", "R1 (1).csv", True),  # the later of two downloads
        ("copy of R1.csv", "R1.csv", True),
        ("R1 - Kopie.csv", "R1.csv", True),
        ("R1.csv", "R2.csv", False),
        ("R1.csv", "R12.csv", False),
        ("a/R1_backup.csv", "R1.csv", False),
        ("old/R1.csv", "R1.csv", True),
        ("R1.csv.bak", "R1.csv", True),
    ],
)
def test_a_file_that_another_one_goes_on_is_its_beginning(tmp_path: Path, short: str, long: str, is_one: bool) -> None:
    paths = [PurePosixPath(p) for p in (short, long)]
    for path, text in zip(paths, (LOG[: len(LOG) // 2], LOG), strict=True):
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text)
    assert beginnings_in(tmp_path, paths) == ({paths[0]: paths[1]} if is_one else {})
    (tmp_path / short).write_text(LOG[: len(LOG) // 2].replace("20.3", "20.4"))
    assert beginnings_in(tmp_path, paths) == {}


def test_a_draft_takes_no_beginning_of_a_log_for_a_test_and_names_it(tmp_path: Path, say: Callable[..., Said]) -> None:
    for i in (1, 2):
        (tmp_path / f"R{i}.csv").write_text(LOG.replace("20.0", f"2{i}.0"))
    (tmp_path / "R1_backup.csv").write_text(LOG.replace("20.0", "21.0")[:400])
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text()
    assert text.count("  - {id:") == 2
    assert "# not used: R1_backup.csv: the beginning of R1.csv, byte by byte" in text


def dated(first: str = "2026-03-02T08:00:00", n: int = 60, rise: float = 0.1) -> str:
    at = np.datetime64(first) + np.arange(n).astype("timedelta64[m]")
    return "time;T_front [degC]\n" + "".join(f"{t}Z;{20 + rise * i:.1f}\n" for i, t in enumerate(at))


@pytest.mark.parametrize("suffix", [".part", ".crdownload", ".tmp"])
def test_a_half_written_copy_is_left_out_and_said(tmp_path: Path, suffix: str) -> None:
    (tmp_path / "V2.csv").write_text(dated())
    (tmp_path / f"V2.csv{suffix}").write_text(dated(n=30))
    draft = draft_files(tmp_path).draft
    assert [t.id for t in draft.tests] == ["V2"]
    assert len(draft.sources) == 1
    assert dict(draft.not_used)[f"V2.csv{suffix}"] == "by its name a half-written copy of V2.csv, which is there"


def test_one_without_the_finished_file_beside_it_is_a_log(tmp_path: Path) -> None:
    (tmp_path / "V2.csv.part").write_text(dated())
    assert len(draft_files(tmp_path).draft.tests) == 1


@pytest.mark.parametrize(
    ("name", "first", "asked"),
    [
        ("V1_corrected.csv", "2026-03-02T08:00:00", True),
        ("V1_cold.csv", "2026-03-02T09:30:00", False),
        ("X7.csv", "2026-03-02T08:00:00", False),
    ],
)
def test_another_version_of_a_log_is_asked(tmp_path: Path, name: str, first: str, asked: bool) -> None:
    (tmp_path / "V1.csv").write_text(dated())
    (tmp_path / name).write_text(dated(first, rise=0.2))
    doubts = {t.id: t.doubts for t in draft_files(tmp_path).draft.tests}
    assert ("another version of V1.csv? it has the same minutes" in doubts[name[:-4]]) is asked
    assert not doubts["V1"]


def test_a_draft_says_why_a_table_is_not_read(tmp_path: Path) -> None:
    (tmp_path / "run1.csv").write_text(LOG)
    rows = [f"2026-03-02 08:{k:02d}:00,{20 + k / 10} °C,{30 + k / 10} °C" for k in range(50)]
    (tmp_path / "dashboard.csv").write_text("\n".join(["Time,Spindle front,Hall", *rows]), encoding="utf-8")
    draft_files(tmp_path)
    (said,) = [x for x in (tmp_path / "campaign.yaml").read_text().splitlines() if "dashboard.csv" in x]
    assert "cells that hold their units beside their numbers" in said


def test_names_of_thousands_of_files_are_compared_in_linear_time(tmp_path: Path) -> None:
    paths = [PurePosixPath(f"run_{k:04d}_T01.csv") for k in range(4000)]
    for k, path in enumerate(paths):
        (tmp_path / path).write_text(f"time [s];T\n0;{k}\n" + "1;20\n" * (k % 300))
    backup = PurePosixPath("backup/run_0007_T01.csv")
    (tmp_path / "backup").mkdir()
    (tmp_path / backup).write_text("time [s];T\n0;7\n")
    began = time.process_time()
    assert beginnings_in(tmp_path, [*paths, backup]) == {backup: paths[7]}
    assert time.process_time() - began < 20  # pair by pair it took ten minutes
