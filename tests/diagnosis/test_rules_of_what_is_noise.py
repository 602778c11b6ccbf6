"""Falls of errors, as shares of what is more than noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.claims.probability import probability
from thermodata.diagnosis.claims.rules import rules
from thermodata.diagnosis.weigh.beyond_noise import beyond, fall_beyond
from thermodata.diagnosis.weigh.figures import of_more_than_noise
from thermodata.diagnosis.weigh.foretold import Foretold, Looked

from .hand_made import measure, scored


def test_an_error_without_its_noise() -> None:
    assert beyond(5.0, 3.0, 1e9) == pytest.approx(4.0)
    assert beyond(5.0, 0.0, 100) == 5.0
    assert beyond(0.0, 3.0, 100) == 0.0


@pytest.mark.parametrize(("rows", "least"), [(2, 1.0), (32, 0.5), (20000, 0.1)])
def test_so_many_rows_tell_no_less_of_it(rows: int, least: float) -> None:
    """Drawn: the error of white noise alone, less its variance, is that large in one case of six at most."""
    assert beyond(1.0, 1.0, rows) == pytest.approx(least)
    rng = np.random.default_rng(3)
    errors = np.sqrt(np.mean(rng.normal(0.0, 1.0, (400, rows)) ** 2, axis=1))
    assert np.mean([beyond(float(e), 1.0, rows) > 1.0001 * least for e in errors]) < 0.25


@pytest.mark.parametrize(
    ("before", "after", "white", "fall"),
    [
        (2.0, 1.0, 0.0, 0.5),
        (2.0, 1.0, 0.1, 0.503),  # a quiet probe
        (1.61, 1.41, 1.26, 0.37),  # 12 % of the error, most of which is noise
        (1.0, 2.0, 0.9, -1.0),  # a rise is told as it is: beside the noise it would be a multiple
        (1.2, 1.1, 1.26, 0.0),  # both are noise
        (0.0, 0.0, 1.0, 0.0),
    ],
)
def test_a_fall_is_a_share_of_what_is_more_than_noise(before: float, after: float, white: float, fall: float) -> None:
    assert fall_beyond(before, after, white, 350) == pytest.approx(fall, abs=0.01)


def test_a_loud_probe_hides_no_fall_from_the_rule_and_the_probability() -> None:
    """A chiller that moves 5 um was none: of an error of 1.61 um 1.26 are noise, and it fell by 12 %."""
    quiet = scored(before=1.61, after=1.41, evidence=60.0)
    loud = replace(quiet, white=1.26)
    held = [next(r for r in rules(one, measure(floor=0.01), "um") if r.name == "fall") for one in (quiet, loud)]
    assert [r.holds for r in held] == [False, True]
    assert probability(loud) > probability(quiet)
    assert "falls by 12 % only" in str(held[0].fails)


def test_locked_tests_weigh_what_falls_of_more_than_noise() -> None:
    quiet = Foretold(1.9, 1.5, 1.2)
    loud = replace(quiet, white=1.26, rows=84)
    assert Looked(loud, loud, 0.0).log_odds > 0 > Looked(quiet, quiet, 0.0).log_odds


def test_words_say_what_the_fall_is_a_share_of() -> None:
    assert of_more_than_noise(0.37, 1.61, 1.41) == " of what is more than noise"
    assert of_more_than_noise(0.124, 1.61, 1.41) == ""
