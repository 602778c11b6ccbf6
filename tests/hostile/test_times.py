"""Clocks as labs have them: newest first, without daylight saving, in hours, beside a rising temperature."""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import Any

import numpy as np
import pytest

from .conftest import Lab

T1 = {"T1": {"signal": "T", "quantity": "temperature", "unit": "degC"}}


def stamps(start: str, step_s: int, n: int) -> list[str]:
    first = datetime.fromisoformat(start)
    return [f"{first + timedelta(seconds=step_s * i):%Y-%m-%d %H:%M:%S}" for i in range(n)]


def rows(times: list[Any], between: str = ";") -> str:
    return "".join(f"{t}{between}{20 + i / 8}\n" for i, t in enumerate(times))


@pytest.mark.parametrize(
    "times",
    [
        stamps("2026-03-02 08:00:00", 10, 200)[::-1],
        list(range(1990, -1, -10)),
        [t[11:] for t in stamps("2026-03-02 23:55:00", 10, 200)][::-1],
    ],
    ids=["dates", "seconds", "times of day over midnight"],
)
def test_a_file_that_stands_newest_first_is_turned_round(lab: Lab, times: list[Any]) -> None:
    lab.write("raw/a.csv", "time;T\n" + rows(times))
    said = lab.ingest(T1)
    assert said.code == 0, said.err
    t_s, values = lab.values("T1")
    np.testing.assert_allclose(t_s - t_s[0], np.arange(200) * 10.0)
    np.testing.assert_array_equal(values, 20 + np.arange(200)[::-1] / 8)
    assert "newest first" in said.out and "newest first" in lab("preview", lab.folder / "raw/a.csv").out
    traced = lab("trace", "odd", "one", "T1", "--at", "0 s", "--verify")
    assert "line 201" in traced.out and traced.code == 0


def test_files_that_stand_newest_first_are_joined_in_order(lab: Lab) -> None:
    all_stamps = stamps("2026-03-02 08:00:00", 10, 200)
    lab.write("raw/a.csv", "time;T\n" + rows(all_stamps[:100][::-1]))
    lab.write("raw/b.csv", "time;T\n" + rows(all_stamps[100:][::-1]))
    assert lab.ingest(T1).code == 0
    t_s, values = lab.values("T1")
    np.testing.assert_allclose(t_s, np.arange(200) * 10.0)
    np.testing.assert_array_equal(values, 20 + np.concatenate([np.arange(100)[::-1], np.arange(100)[::-1]]) / 8)
