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
