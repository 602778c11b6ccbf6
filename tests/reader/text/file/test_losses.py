"""Losses are dated from the row before to the row after, over the parts of a file; the first twenty are named."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.reader.text.file.losses import NAMED, Losses


@pytest.mark.parametrize(
    ("row", "column", "between"),
    [
        (0, None, (None, 10)),
        (1, None, (10, 20)),
        (3, None, (30, None)),
        (0, "a", (10, 10)),
        (2, "a", (30, 30)),
    ],
)
def test_a_loss_is_dated_by_the_rows_around_it(
    row: int, column: str | None, between: tuple[int | None, int | None]
) -> None:
    losses = Losses("a.csv", 200)
    losses.add(6, "expected a number", 5, row, column)
    (loss,) = losses.dated(np.array([10, 20, 30], np.int64))
    assert (loss.from_ns, loss.to_ns) == between
    assert loss.where == ("a.csv line 7" if column is None else "a.csv line 7 column 'a'")
    assert loss.fraction == 5 / 200


def test_the_last_row_of_a_part_is_before_the_losses_of_the_next() -> None:
    losses = Losses("a.csv", 200)
    assert losses.dated(np.array([10, 20], np.int64)) == []
    losses.add(3, "torn", 5, 0)
    (loss,) = losses.dated(np.empty(0, np.int64))
    assert (loss.from_ns, loss.to_ns) == (20, None)
    losses.add(4, "torn", 5, 0)
    (loss,) = losses.dated(np.array([30], np.int64))
    assert (loss.from_ns, loss.to_ns) == (20, 30)


def test_a_clock_that_steps_back_leaves_the_end_open() -> None:
    losses = Losses("a.csv", 200)
    losses.add(3, "torn", 5, 1)
    (loss,) = losses.dated(np.array([20, 10], np.int64))
    assert (loss.from_ns, loss.to_ns) == (20, None)


def test_what_is_not_named_is_counted() -> None:
    losses = Losses("a.csv", 200)
    for line in range(NAMED + 3):
        losses.add(line, "torn", 4, 0)
    assert len(losses.dated(np.empty(0, np.int64))) == NAMED == 20
    (rest,) = losses.rest()
    assert (rest.where, rest.fraction) == ("a.csv", 12 / 200)
    assert rest.reason == "3 more cells or rows that do not read"
    assert Losses("a.csv", 200).rest() == []
