"""Two loggers of one make with names of channels in common: where they ran at once they are two sources, whatever their
clocks and files are called; folders that follow each other are one."""

from __future__ import annotations

from datetime import timedelta
from pathlib import Path

import pytest

from tests.draft.folder.test_grouping import drafted
from tests.draft.labs import START, local, numbers, speeds, text, warm
from thermodata.schema.files.campaign import Campaign

N = 360  # rows, 10 s apart


def probes(path: Path, days: float, late_s: float = 0) -> None:
    rows = [numbers(warm(N, 20, k, 1, 1), 2) for k in (1, 2, 3)]
    _write(path, ["dZ [µm]", "T1 [°C]", "T2 [°C]", "n [1/min]"], [*rows, numbers(speeds(N, [3000]), 0)], days, late_s)


def frame(path: Path, days: float, late_s: float = 0) -> None:
    _write(path, ["T1 [°C]", "T2 [°C]"], [numbers(warm(N, 22, k, 1, 1), 2) for k in (1, 2)], days, late_s)


def _write(path: Path, names: list[str], columns: list[list[str]], days: float, late_s: float) -> None:
    times = local(N, 10, START + timedelta(days=days, seconds=late_s), "UTC", "%Y-%m-%d %H:%M:%S")
    text(path, ["Time", *names], [times, *columns])


def _sources_of(made: Campaign, signal: str) -> set[str]:
    return {str(c.source) for c in made.channels.values() if c.signal == signal}


@pytest.mark.parametrize("late_s", [0, 150, 600, -900])
def test_files_of_one_name_in_two_folders_at_one_time_are_of_two_loggers(tmp_path: Path, late_s: float) -> None:
    for day in range(3):
        probes(tmp_path / "DAQ1" / f"P{day}.csv", day)
        frame(tmp_path / "DAQ2" / f"P{day}.csv", day, late_s)
    _, made = drafted(tmp_path)
    assert {s.files for s in made.sources.values()} == {"DAQ1/{test}.csv", "DAQ2/{test}.csv"}
    assert [t.id for t in made.tests] == ["P0", "P1", "P2"]
    assert _sources_of(made, "T1 [°C]") == set(made.sources)


def test_files_called_after_their_starts_are_of_two_loggers(tmp_path: Path) -> None:
    for day in range(3):
        begin = START + timedelta(days=day)
        probes(tmp_path / "A" / f"{begin:%Y-%m-%d_%H%M}.csv", day)
        frame(tmp_path / "B" / f"{begin + timedelta(minutes=2):%Y-%m-%d_%H%M}.csv", day, 130)
    _, made = drafted(tmp_path)
    assert len(made.sources) == 2
    assert len(made.tests) == 3
    assert _sources_of(made, "T1 [°C]") == set(made.sources)


def test_a_word_of_the_names_tells_loggers_whose_clocks_differ(tmp_path: Path) -> None:
    for day in range(3):
        probes(tmp_path / f"P{day}_daq1.csv", day)
        frame(tmp_path / f"P{day}_daq2.csv", day, 400)
    _, made = drafted(tmp_path)
    assert {s.files for s in made.sources.values()} == {"{test}_daq1.csv", "{test}_daq2.csv"}


def test_a_test_that_one_logger_missed(tmp_path: Path) -> None:
    for day in range(4):
        probes(tmp_path / "DAQ1" / f"P{day}.csv", day)
        if day != 2:
            frame(tmp_path / "DAQ2" / f"P{day}.csv", day, 150)
    _, made = drafted(tmp_path)
    assert {s.files for s in made.sources.values()} == {"DAQ1/{test}.csv", "DAQ2/{test}.csv"}
    assert len(made.tests) == 4


def test_folders_that_follow_each_other_are_of_one_logger(tmp_path: Path) -> None:
    for day in range(4):
        probes(tmp_path / f"week{1 + day // 2}" / f"P{day % 2}.csv", day)
    _, made = drafted(tmp_path)
    assert len(made.sources) == 1
    assert len(made.tests) == 4


def test_folders_whose_tests_hardly_touch_are_of_one_logger(tmp_path: Path) -> None:
    for day in range(3):
        probes(tmp_path / "morning" / f"P{day}.csv", day)
        frame(tmp_path / "later" / f"P{day}.csv", day, 0.7 * N * 10)
    _, made = drafted(tmp_path)
    assert len(made.sources) == 1
    assert len(made.tests) == 6
