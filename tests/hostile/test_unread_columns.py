"""What is lost of a column that no channel reads: told, and no loss of the ingest."""

from __future__ import annotations

import json

import pytest

from .conftest import Lab
from .test_times import stamps

ROWS = 2500  # a column is typed by the first 2000
TIMES = stamps("2026-03-02 08:00:00", 10, ROWS)
T1 = {"signal": "T1", "quantity": "temperature", "unit": "degC"}


def log(lab: Lab, column: str, usual: str, words: int) -> None:
    rows = [f"{t};20.{i % 100:02};{'Logged' if i >= ROWS - words else usual}" for i, t in enumerate(TIMES)]
    lab.write("raw/a.csv", "\n".join([f"time;T1;{column}", *rows, ""]))


@pytest.mark.parametrize("words", [1, 30])
@pytest.mark.parametrize("usual", ["", "0"])
def test_a_status_that_ends_in_words_is_no_loss_where_no_channel_reads_it(lab: Lab, usual: str, words: int) -> None:
    log(lab, "End Of File", usual, words)
    said = lab.ingest({"T1": T1})
    assert said.code == 0, said.out + said.err
    assert "expected a number, got 'Logged'; no channel reads that column" in said.out + said.err
    assert lab.values("T1")[1].size == ROWS
    said = lab.ingest({"T1": T1, "end": {"signal": "End Of File", "quantity": "state"}})
    assert said.code == 3
    assert "expected a number, got 'Logged'" in said.out + said.err


def test_words_in_a_column_of_qualities_concern_the_values(lab: Lab) -> None:
    log(lab, "T1.Quality", "192", 1)
    assert lab.ingest({"T1": T1}).code == 3


@pytest.mark.parametrize(("signal", "code"), [("dZ [mm]", 3), ("dZ", 3), ("dX [mm]", 0)])
def test_a_loss_in_a_part_that_has_a_channel_in_another_unit_is_one(lab: Lab, signal: str, code: int) -> None:
    for name, unit, hour in (("a", "mm", "08"), ("b", "um", "16")):
        rows = [f"{t.replace(' 08:', f' {hour}:')};20.5;1.{i % 10};2" for i, t in enumerate(TIMES[:300])]
        if name == "b":
            rows[200] = rows[200].replace(f";1.{200 % 10};", ";Logged;")
        lab.write(f"raw/{name}.csv", "\n".join([f"time;T1;dZ [{unit}];dX [{unit}]", *rows, ""]))
    said = lab.ingest({"T1": T1, "d": {"signal": signal, "quantity": "displacement", "at": "tcp", "axis": "Z"}})
    assert said.code == code, said.out + said.err
    assert ("no channel reads that column" in said.out + said.err) is (code == 0)


@pytest.mark.parametrize("first", [True, False])
@pytest.mark.parametrize(("reads", "code"), [("End Of File", 3), ("T1", 0)])
def test_a_loss_of_a_file_of_two_sources_is_one_where_either_reads_it(
    lab: Lab, first: bool, reads: str, code: int
) -> None:
    log(lab, "End Of File", "0", 1)
    names = ["log", "other"] if first else ["other", "log"]
    sources = {name: {"reader": "table", "files": "raw/*"} for name in names}
    channel = T1 if reads == "T1" else {"signal": reads, "quantity": "state"}
    said = lab.ingest({"T1": T1, "end": {**channel, "source": "other"}}, sources=sources)
    assert said.code == code, said.out + said.err
    assert ("no channel reads that column" in said.out + said.err) is (code == 0)


@pytest.mark.parametrize("zone", ["UTC", "Europe/Prague"], ids=["read alike", "read each in its own way"])
def test_what_is_lost_of_a_file_of_two_sources_is_told_once_of_those_that_miss_it(lab: Lab, zone: str) -> None:
    rows = [f"{t};20.{i % 100:02};30.{i % 100:02}" for i, t in enumerate(TIMES[:300])]
    rows[100] = rows[100].replace(";20.00;", ";garbage;")  # a cell that one of the sources misses
    rows[150] = rows[150].rpartition(";")[0]  # a row that both miss
    lab.write("raw/a.csv", "\n".join(["time;T1;T2", *rows, ""]))
    sources = {
        "first": {"reader": "table", "files": "raw/*", "timezone": "UTC"},
        "second": {"reader": "table", "files": "raw/*", "timezone": zone},
    }
    channels = {"T1": {**T1, "source": "first"}, "T2": {**T1, "signal": "T2", "source": "second"}}
    said = lab.ingest(channels, sources=sources)
    cell, row = "expected a number, got 'garbage' (one, first, raw/a.csv", "(one, first, second, raw/a.csv"
    for text in (said.out, lab("quality").out):
        assert cell in text
        assert row in text
        assert "2 times" not in text
        assert text.count("garbage") == 1
        assert "no channel reads" not in text
    told = json.loads(lab("ingest", lab.folder / "campaign.yaml", "--json").out)["losses"]
    assert [(x["source"], x["sources"]) for x in told] == [("first", ["first"]), ("first", ["first", "second"])]


def test_a_file_that_two_sources_cannot_read_is_one_loss(lab: Lab) -> None:
    lab.write("raw/a.csv", "a few words\n")
    sources = {name: {"reader": "table", "files": "raw/*", "timezone": "UTC"} for name in ("first", "second")}
    said = lab.ingest({"T1": {**T1, "source": "first"}, "T2": {**T1, "source": "second"}}, sources=sources)
    assert said.code == 3
    told = json.loads(lab("ingest", lab.folder / "campaign.yaml", "--json").out)["losses"]
    assert [x["sources"] for x in told if x["file"]] == [["first", "second"]]


def test_what_no_channel_reads_is_told_so_by_quality_too(lab: Lab) -> None:
    log(lab, "End Of File", "0", 1)
    assert lab.ingest({"T1": T1}).code == 0
    assert "got 'Logged'; no channel reads that column" in lab("quality").out
    assert lab.ingest({"T1": T1, "end": {"signal": "End Of File", "quantity": "state"}}).code == 3
    assert "no channel reads that column" not in lab("quality").out


def test_what_a_file_lost_is_told_once_for_all_tests_that_are_cut_from_it(lab: Lab) -> None:
    rows = [f"{60 * i},{20 + i / 10}" for i in range(120)]
    rows[3] = "180,2x"
    lab.write("raw/long.csv", "time [s],T [degC]\n" + "\n".join(rows) + "\n")
    tests = [
        {"id": name, "files": {"log": "raw/long.csv"}, "window": window}
        for name, window in (("early", ["0 h", "1 h"]), ("late", ["1 h", "2 h"]))
    ]
    channel = {"T1": {"signal": "T", "quantity": "temperature", "at": "hall"}}
    for _ in range(2):  # the second time from what was noted
        said = lab.ingest(channel, tests=tests)
        assert said.code == 3
        (line,) = [line for line in said.out.splitlines() if "2x" in line]
        assert "times:" not in line
        assert "(early, late, log, raw/long.csv" in line
    told = json.loads(lab("ingest", lab.folder / "campaign.yaml", "--json").out)["losses"]
    assert [(row["test"], row["tests"], row["file"]) for row in told] == [("early", ["early", "late"], "raw/long.csv")]
    (line,) = [line for line in lab("quality").out.splitlines() if "2x" in line]
    assert "times:" not in line
    assert "(early, late, log, raw/long.csv" in line


def test_a_file_of_two_tests_that_nobody_can_read_is_told_once(lab: Lab) -> None:
    lab.write("raw/long.csv", b"\x00\x01 nothing")
    tests = [{"id": name, "files": {"log": "raw/long.csv"}} for name in ("early", "late")]
    lab.ingest({"T1": T1}, tests=tests)
    told = json.loads(lab("ingest", lab.folder / "campaign.yaml", "--json").out)["losses"]
    assert [row["tests"] for row in told if row["file"] == "raw/long.csv"] == [["early", "late"]]
