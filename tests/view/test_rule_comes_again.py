"""A state that comes again in a test tells a stretch of it only where all of it is as bad."""

from __future__ import annotations

import re

import numpy as np
import pytest

from thermodata.view.curves.predictions import Prediction
from thermodata.view.curves.rule_for import range_rule, rules

N = 720
MOVES = np.zeros(N)
MOVES[320:400] = MOVES[500:600] = 12.0  # the axis cuts twice; the probe is out of its range then


def predicted(residual: np.ndarray) -> Prediction:
    t_s = np.arange(N) * 60.0
    return Prediction("c", "day", "dZ", t_s, residual, np.zeros(N), residual, np.ones(N, bool), {}, {})


def test_a_rule_takes_the_other_times_too_where_they_are_as_bad() -> None:
    residual = np.where(MOVES > 0, 200.0, 2.0)
    found = rules(predicted(residual), {"feed_X": MOVES}, 320 * 60.0, 399 * 60.0)
    assert {r.text for r in found} == {"feed_X == 0", "feed_X < 6"}
    assert (found[0].taken, found[0].lost) == (80, 100)
    assert found[0].rmse == 2.0


def test_it_takes_none_where_the_other_times_are_good() -> None:
    residual = np.full(N, 2.0)
    residual[320:400] = 200.0
    assert rules(predicted(residual), {"feed_X": MOVES}, 320 * 60.0, 399 * 60.0) == []


def test_a_state_that_is_the_stretch_alone_comes_first() -> None:
    alone = np.zeros(N)
    alone[320:400] = 1.0
    residual = np.where(MOVES > 0, 200.0, 2.0)
    found = rules(predicted(residual), {"feed_X": MOVES, "door": alone}, 320 * 60.0, 399 * 60.0)
    assert {r.text.split()[0] for r in found} == {"door"}


def test_a_probe_at_the_end_of_its_range_gives_the_range() -> None:
    measured = 5 * np.sin(np.arange(N) / 90)
    measured[320:400] = measured[500:600] = 235.0
    measured[320] = 120.0  # half of it out
    found = range_rule(predicted(measured), "um", 320 * 60.0, 399 * 60.0)
    assert found is not None
    assert found.text.startswith("{in_range: {dZ: [-")
    assert (found.taken, found.lost) == (79, 100)
    turned = range_rule(predicted(-measured), "um", 320 * 60.0, 399 * 60.0)
    assert turned is not None
    assert (turned.taken, turned.lost) == (79, 100)


@pytest.mark.parametrize(("usual", "end"), [(1823.0, 1884.0), (1056.0, 1067.0), (-1240.0, -1300.0), (0.2, -0.7)])
def test_its_limits_lie_between_what_it_measures_and_its_end(usual: float, end: float) -> None:
    measured = usual + (end - usual) / 8 * np.sin(np.arange(N) / 90)
    measured[320:400] = end
    found = range_rule(predicted(measured), "um", 320 * 60.0, 399 * 60.0)
    assert found is not None
    assert (found.taken, found.lost) == (80, 0)
    low, high = map(float, re.findall(r"(-?[\d.e+-]+) um", found.text))
    assert ((measured >= low) & (measured <= high)).tolist() == (measured != end).tolist(), "as it is written"


def test_a_probe_that_creeps_is_at_no_end() -> None:
    warm = np.where(np.arange(N) < 300, 0.0, 40 * (1 - np.exp(-(np.arange(N) - 300) / 8)))
    warm[450:] = 40 * np.exp(-(np.arange(450, N) - 450) / 8)  # it stands at its warmest, and cools again
    assert range_rule(predicted(warm), "um", 330 * 60.0, 449 * 60.0) is None
    assert range_rule(predicted(np.linspace(0, 50, N)), "um", 320 * 60.0, 399 * 60.0) is None
    assert range_rule(predicted(5 * np.sin(np.arange(N) / 90)), "um", 320 * 60.0, 399 * 60.0) is None
