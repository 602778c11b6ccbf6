"""A table of many tests below each other: a column that names the test parts it, where its words stand in blocks."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from tests.commands import Say
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.load import load_campaign

BEGAN = datetime(2026, 3, 2, 8)
ROWS = 60


def table(path: Path, column: str, said: Sequence[str], *, dates: bool = True) -> None:
    """A block of rows a word, a day apart, or each from 0 s on; a temperature that begins at 20 in each."""
    lines = [f"{column},{'time' if dates else 'time_s'},T_front"]
    for k, word in enumerate(said):
        for i in range(ROWS):
            t = (BEGAN + timedelta(days=k, minutes=i)).isoformat(" ") if dates else 60 * i
            lines.append(f"{word},{t},{20 + k + i / 100:.2f}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def drafted(folder: Path, say: Say) -> Campaign:
    assert say("init", folder).code == 0
    return load_campaign(folder / "campaign.yaml")


def counted(folder: Path, say: Say) -> list[dict[str, object]]:
    store = ("--store", folder / "s")
    say(*store, "ingest", folder / "campaign.yaml")
    asked = (
        "select test, min(t_s) as t, min(value) as first, count(*) as n from sample "
        "where channel = 'T_front' group by test order by first"
    )
    found: list[dict[str, object]] = json.loads(say(*store, "sql", asked, "--json").out)
    return found


ALL = [{"test": test, "t": 0.0, "first": 20.0 + k, "n": ROWS} for k, test in enumerate(("A_3000", "B", "C"))]


@pytest.mark.parametrize("column", ["test", "Versuch Nr.", "run_id", "Pomiar"])
def test_each_word_is_a_test_with_its_window(tmp_path: Path, say: Say, column: str) -> None:
    table(tmp_path / "all.csv", column, ("A_3000", "B", "C"))
    campaign = drafted(tmp_path, say)
    assert [(t.id, t.window) for t in campaign.tests] == [
        ("A_3000", (0.0, 3600.0)),
        ("B", (86_400.0, 90_000.0)),
        ("C", (172_800.0, 176_400.0)),
    ]
    assert list(campaign.channels) == ["T_front"]
    assert counted(tmp_path, say) == ALL


def test_times_that_begin_anew_are_joined_once_the_clock_may_be_set(tmp_path: Path, say: Say) -> None:
    table(tmp_path / "all.csv", "test", ("A_3000", "B", "C"), dates=False)
    drafted(tmp_path, say)
    path = tmp_path / "campaign.yaml"
    text = path.read_text(encoding="utf-8")
    assert "# ? its rows name tests, and times begin anew with each: add clock: {resets: allow}" in text
    path.write_text(text.replace("{series: none}}", "{series: none}, clock: {resets: allow}}"), encoding="utf-8")
    assert counted(tmp_path, say) == ALL


@pytest.mark.parametrize(
    ("column", "said"),
    [
        ("state", ("heating", "cooling")),  # what the machine did, no test
        ("run", ("idle", "cutting")),
        ("test", ("A", "B", "A")),  # no one window
        ("test", ("A",)),
        ("test", ("0", "1")),  # a switch
        ("test_rig_temperature", ("20", "30")),
    ],
)
def test_other_columns_part_nothing(tmp_path: Path, say: Say, column: str, said: Sequence[str]) -> None:
    table(tmp_path / "all.csv", column, said)
    campaign = drafted(tmp_path, say)
    assert [(t.id, t.window) for t in campaign.tests] == [("all", None)]
    asked = "may name tests" in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert asked is (said == ("A", "B", "A"))


def test_a_table_of_which_some_is_lost_is_asked(tmp_path: Path, say: Say) -> None:
    table(tmp_path / "all.csv", "test", ("A", "B"))
    text = (tmp_path / "all.csv").read_text(encoding="utf-8").replace("2026-03-03 08:30:00,", "2026-03-, 08:3")
    (tmp_path / "all.csv").write_text(text, encoding="utf-8")
    assert [t.window for t in drafted(tmp_path, say).tests] == [None]
    assert "may name tests" in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")


def test_sensors_below_each_other_are_no_tests(tmp_path: Path, say: Say) -> None:
    table(tmp_path / "all.csv", "sensor", ("front", "rear"), dates=False)
    assert say("init", tmp_path).code == 0
    assert "window" not in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")


def test_a_second_log_makes_the_windows_a_question(tmp_path: Path, say: Say) -> None:
    table(tmp_path / "all.csv", "test", ("A", "B"))
    for test in ("A", "B"):
        rows = "".join(f"2026-03-0{2 + (test == 'B')} 08:{i:02}:00;{1000 + i}\n" for i in range(ROWS))
        (tmp_path / f"{test}.csv").write_text(f"Datum;Drehzahl [U/min]\n{rows}", encoding="utf-8")
    drafted(tmp_path, say)
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert text.count("# ? window: it is counted in one log") == 2


def test_two_tests_of_other_rates_that_begin_anew_are_tests_too(tmp_path: Path, say: Say) -> None:
    lines = ["test,time_s,T_front", *(f"A,{60 * i},{20 + i / 100:.2f}" for i in range(61))]
    lines += [f"B,{20 * i},{30 + i / 100:.2f}" for i in range(181)]
    (tmp_path / "all.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    assert [(t.id, t.window) for t in drafted(tmp_path, say).tests] == [("A", (0.0, 3660.0)), ("B", (3660.0, 7280.0))]
    path = tmp_path / "campaign.yaml"
    text = path.read_text(encoding="utf-8")
    assert text.count("add clock: {resets: allow}") == 1
    path.write_text(text.replace("files: all.csv", "files: all.csv, clock: {resets: allow}"), encoding="utf-8")
    assert [(row["test"], row["first"], row["n"]) for row in counted(tmp_path, say)] == [
        ("A", 20.0, 61),
        ("B", 30.0, 181),
    ]


def test_tests_that_stand_in_another_order_than_their_dates_are_asked(tmp_path: Path, say: Say) -> None:
    table(tmp_path / "all.csv", "test", ("A", "B"))
    head, *lines = (tmp_path / "all.csv").read_text(encoding="utf-8").splitlines()
    turned = "\n".join((head, *lines[ROWS:], *lines[:ROWS]))
    (tmp_path / "all.csv").write_text(turned + "\n", encoding="utf-8")
    assert [(t.id, t.window) for t in drafted(tmp_path, say).tests] == [("all", None)]
    assert "? 'test' may name tests" in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")


@pytest.mark.parametrize("column", ["Mesure", "Messung", "Meting"])
@pytest.mark.parametrize("reading", [lambda i: f"{i / 7:.3f}", lambda i: f"{i % 50}.0", str])
def test_readings_that_are_called_as_tests_are_no_names(
    tmp_path: Path, say: Say, column: str, reading: Callable[[int], str]
) -> None:
    times = (BEGAN + timedelta(seconds=10 * i) for i in range(600))
    rows = "".join(f"{t.isoformat(' ')},{reading(i)},20.{i % 7}\n" for i, t in enumerate(times))
    (tmp_path / "all.csv").write_text(f"time,{column},T_front\n{rows}", encoding="utf-8")
    campaign = drafted(tmp_path, say)
    assert [t.window for t in campaign.tests] == [None]
    assert "may name tests" not in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")


def test_whole_numbers_in_few_blocks_are_names_of_tests(tmp_path: Path, say: Say) -> None:
    table(tmp_path / "all.csv", "Messung", ("1.0", "2.0", "3.0"))
    assert [t.id for t in drafted(tmp_path, say).tests] == ["1", "2", "3"]


def test_a_file_for_which_no_time_is_left_is_asked(tmp_path: Path, say: Say, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("thermodata.draft.folder.look._SAMPLES_S", -1.0)
    table(tmp_path / "all.csv", "test", ("A", "B"))
    assert [t.window for t in drafted(tmp_path, say).tests] == [None]
    assert "may name tests" in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")


def test_the_start_of_probes_beside_rows_of_a_log_is_said_with_the_window_that_counts_from_it(
    tmp_path: Path, say: Say
) -> None:
    """The window counts from the start of the probes once they have one: given alone, it would cut them off."""
    table(tmp_path / "registro.csv", "test", ("A", "B", "C"))
    for test in "ABC":
        rows = "\n".join(f"{60 * i},{i / 7:.3f}" for i in range(ROWS))
        (tmp_path / f"{test}.csv").write_text(f"t [s],Z [um]\n{rows}\n")
    drafted(tmp_path, say)
    path = tmp_path / "campaign.yaml"
    (asked,) = [x for x in path.read_text().splitlines() if "id: B" in x]
    assert "start: 2026-03-03 08:00:00 in the test, and window: [0 s, 3600 s] in its place" in asked
    as_drafted = say("--store", tmp_path / "t", "ingest", path)
    assert "', and with it window: [0 s, 3600 s]" in as_drafted.out
    text = path.read_text()
    for k, test in enumerate("ABC"):
        text = text.replace(f"id: {test}, ", f'id: {test}, start: "2026-03-0{2 + k} 08:00:00", ')
    path.write_text(re.sub(r"window: \[\d+ s, \d+ s\]", "window: [0 s, 3600 s]", text))
    assert [row["n"] for row in counted(tmp_path, say)] == [ROWS, ROWS, ROWS]


def test_beside_a_log_with_dates_only_the_window_is_asked(tmp_path: Path, say: Say) -> None:
    table(tmp_path / "registro.csv", "test", ("A", "B", "C"))
    for k, test in enumerate("ABC"):
        rows = "\n".join(f"{BEGAN + timedelta(days=k, minutes=i)},{i / 7:.3f}" for i in range(ROWS))
        (tmp_path / f"{test}.csv").write_text(f"time,Z [um]\n{rows}\n")
    drafted(tmp_path, say)
    assert "start:" not in (tmp_path / "campaign.yaml").read_text().partition("tests:")[2]
