"""A jump test of few rows, as of a logger that writes every 5 s, has its steps and its dwell."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.draft.labs import numbers, text
from thermodata.draft.files.sample import Course
from thermodata.draft.make import draft_files
from thermodata.draft.probes.jumps import staircase

MOVES = (0.0, -3.97, 0.0, 3.97, 0.0, 0.0)


def _course(on_each: int, levels: tuple[float, ...] = MOVES) -> Course:
    """A probe every 5 s, so many samples at each level [V]."""
    x = 5.1 + np.repeat(levels, on_each)
    noise = np.random.default_rng(3).normal(0, 0.0035, x.size)
    return Course(5_000_000_000 * np.arange(x.size), x + noise)


@pytest.mark.parametrize(("on_each", "seen"), [(5, True), (6, True), (3, False)])
def test_steps_of_few_samples_are_seen(on_each: int, seen: bool) -> None:
    found = staircase(_course(on_each))
    assert (found is not None) is seen
    if found is not None:
        assert [round(s.size, 1) for s in found[0]] == [-4.0, 4.0, 4.0, -4.0]
        assert found[1] == pytest.approx(5.0 * on_each)


@pytest.mark.parametrize("levels", [(0.0,) * 6, (0.0, 0.4, 0.8, 1.2, 1.6, 2.0)])
def test_what_stands_or_creeps_has_none(levels: tuple[float, ...]) -> None:
    course = _course(6, levels)
    x = course.values if levels[1] == 0.0 else np.linspace(5.0, 7.0, course.values.size)
    assert staircase(Course(course.t_ns, x)) is None


def test_the_dwell_is_drafted_of_what_is_seen(tmp_path: Path) -> None:
    course = _course(6)
    t = np.arange(course.values.size) * 5.0
    text(tmp_path / "Sprung_X.csv", ["t [s]", "Weg X [V]"], [numbers(t, 0), numbers(course.values, 4)])
    slow = np.arange(0, 7200, 5.0)
    text(tmp_path / "V1.csv", ["t [s]", "Weg X [V]"], [numbers(slow, 0), numbers(5 + slow / 9000, 4)])
    draft_files(tmp_path)
    drafted = (tmp_path / "campaign.yaml").read_text("utf-8")
    assert "dwell: 30 s" in drafted
    assert "no steps were seen" not in drafted
