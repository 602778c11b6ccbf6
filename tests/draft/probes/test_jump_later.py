"""A jump test in the midst or at the end of a long test is asked for; what only steps as a test does is not."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from tests.draft.labs import numbers, text
from thermodata.draft.make import draft_files

_HOURS = 3


def _asked(
    folder: Path,
    at_s: float | None,
    *,
    probes: str = "XYZ",
    moves: Sequence[float] = (1.0, -1.0),
    dwell_s: float = 20.0,
    every_s: float = 1.0,
    turn: bool = True,
    pause: bool = True,
    hours: int = _HOURS,
    times: int = 1,
) -> list[str]:
    """What is asked of the window of a test in which the axes were moved from a time on. pause: the spindle stands
    meanwhile; times: how often, an hour apart."""
    rng = np.random.default_rng(1)
    t = np.arange(0, hours * 3600, every_s)
    on = (t > 300) & (t < hours * 3600 - 900)
    columns = {"t [s]": numbers(t, 0)}
    for j, probe in enumerate(probes):
        v = 5 + 0.6 * (1 - np.exp(-np.maximum(t - 300, 0) / 3000)) + 0.001 * rng.normal(size=t.size)
        for k in range(times if at_s is not None else 0):
            begins = (at_s or 0) + k * 3600 + (j * (len(moves) + 1) * dwell_s if turn else 0)
            for i, move in enumerate(moves):
                v = v + move * (t >= begins + i * dwell_s)
            if pause:
                on &= ~((t > begins - 60) & (t < begins + 60 + dwell_s * len(moves)))
        columns[f"{probe} [V]"] = numbers(v, 4)
    columns["n [rpm]"] = numbers(np.where(on, 6000.0, 0.0), 0)
    text(folder / "W01.csv", list(columns), list(columns.values()), mark=",")
    (test,) = draft_files(folder).draft.tests
    return [d for d in test.doubts if d.startswith("window: '")]


@pytest.mark.parametrize(
    ("at_s", "hours", "every_s", "window"),
    [
        (9000 + 1200, 3, 1.0, "[0 s, 10199 s]"),  # at the end
        (5000, 3, 1.0, "[5140 s, 10799 s]"),  # later than half an hour, in a pause
        (9 * 3600, 18, 1.0, "[0 s, 32397 s]"),  # no point of a course lies on a plateau
        (5 * 3600 + 3000, 6, 5.0, "[0 s, 20995 s]"),  # four samples a dwell
    ],
)
def test_a_jump_test_later_in_a_long_test(tmp_path: Path, at_s: float, hours: int, every_s: float, window: str) -> None:
    (asked,) = _asked(tmp_path, at_s, hours=hours, every_s=every_s)
    assert asked.startswith("window: 'X [V]', 'Y [V]', 'Z [V]' go up and down in steps from ")
    a, b = (float(x.split()[0]) for x in asked.rpartition("window: [")[2].split("]")[0].split(", "))
    low, high = (float(x.split()[0]) for x in window[1:-1].split(", "))
    assert a == pytest.approx(low, abs=5)
    assert b == pytest.approx(high, abs=6)
    assert "under calibrations {kind: jump, file: W01.csv, ...}" in asked


def test_one_at_either_end_leaves_what_lies_between(tmp_path: Path) -> None:
    (asked,) = _asked(tmp_path, 60, times=2, pause=False, dwell_s=15.0)
    assert "in the first " in asked or "from 59 to" in asked
    assert asked.startswith("window: ")


@pytest.mark.parametrize(
    "said",
    [
        {"at_s": None},
        {"at_s": 5400, "pause": False},  # while the spindle turns
        {"at_s": 5400, "moves": (1.0,)},  # one step that stays
        {"at_s": 5400, "moves": (1.0, 0.5)},  # it does not come back
        {"at_s": 5400, "probes": "Z"},  # one probe there and back once: it was touched
        {"at_s": 5400, "turn": False},  # all at once: the table was
        {"at_s": 1900, "hours": 12, "times": 9},  # again and again: it is how the test measures
    ],
)
def test_what_is_no_jump_test(tmp_path: Path, said: dict[str, object]) -> None:
    assert _asked(tmp_path, **said) == []  # type: ignore[arg-type]


def test_one_probe_to_and_fro_in_a_pause(tmp_path: Path) -> None:
    (asked,) = _asked(tmp_path, 5400, probes="Z", moves=(1.0, -1.0, 0.5, -0.5))
    assert "'Z [V]' goes up and down" in asked
