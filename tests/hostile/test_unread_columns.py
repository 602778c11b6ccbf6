"""What is lost of a column that no channel reads: told, and no loss of the ingest."""

from __future__ import annotations

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
