"""Quality columns: which value they are of, what their code 0 means, and which rows they call bad."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.reader.text.quality_columns import bad_rows, quality_pairs, worded
from thermodata.reader.text.status import BAD


@pytest.mark.parametrize(
    ("columns", "pairs"),
    [
        ({"T1": ["20"], "T1.Quality": ["192", "0"]}, {"T1": ("T1.Quality", False)}),
        ({"T1": ["20"], "T1 StatusCode": ["0", "2147483648"]}, {"T1": ("T1 StatusCode", True)}),
        ({"T1": ["20"], "T1.Quality": ["0"]}, {"T1": ("T1.Quality", False)}),
        ({"T1": ["20"], "T1 status code": ["0"]}, {"T1": ("T1 status code", True)}),
        ({"T1.Value": ["20"], "T1.Quality": ["192"]}, {"T1.Value": ("T1.Quality", False)}),
        ({"T1": ["20"], "Quality (T1)": ["Good"]}, {"T1": ("Quality (T1)", False)}),
        ({"T1": ["20"], "T2 quality": ["192"]}, {}),
        ({"quality": ["20"], "T1": ["1"]}, {}),
    ],
)
def test_values_and_their_qualities(columns: dict[str, list[str]], pairs: dict[str, tuple[str, bool]]) -> None:
    assert quality_pairs(columns) == pairs


def test_qualities_in_words_or_hexadecimal_are_text() -> None:
    columns = {
        "a": ["1"],
        "a.quality": ["Good"],
        "b": ["1"],
        "b.quality": ["0x80000000"],
        "c": ["1"],
        "c.quality": ["192", ""],
    }
    assert worded(columns, quality_pairs(columns)) == {"a.quality", "b.quality"}


@pytest.mark.parametrize(
    ("values", "zero", "bad"),
    [
        (np.array([192.0, 0.0, np.nan, 64.0, 63.0]), False, [0, 1, 0, 0, 1]),
        (np.array([0.0, 2147483648.0, 1073741824.0]), True, [0, 1, 0]),
        (np.array([192, 0, 24], np.int64), False, [0, 1, 1]),
        (np.array(["Good", None, "Bad", "uncertain", "", "OK"], object), False, [0, 0, 1, 0, 0, 0]),
        (np.array([True, False]), False, [0, 1]),
    ],
)
def test_rows_that_are_called_bad(values: np.ndarray, zero: bool, bad: list[int]) -> None:
    assert bad_rows(values, zero).tolist() == [b * BAD for b in bad]
