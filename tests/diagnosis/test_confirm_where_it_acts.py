"""A choice of the user's own is asked of the locked tests in which it acts (locked/confirm.py)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.locked.confirm import confirm
from thermodata.diagnosis.locked.confirmation import Confirmation
from thermodata.effect import effect
from thermodata.effect.lag import lag
from thermodata.view.grid.dataset import Dataset, TestData

from .conftest import STEP_S, base, make_data

SCREW = CandidateEffect(effect("feed_screw"), {"temperature": "T_nut_X"}, family="feed_x")


def machine(*rest: str) -> Dataset:
    """A screw that the model lacks. The last two tests are locked; in those named the nut rests."""
    data = make_data(lambda u, t: lag(-2.0 * (u["T_nut_X"] - u["T_nut_X"][0]), 2400, STEP_S))

    def changed(test: TestData) -> TestData:
        if test.test in ("t5", "t6"):
            test = replace(test, role="locked")
        if test.test not in rest:
            return test
        screw = lag(-2.0 * (test.values["T_nut_X"] - test.values["T_nut_X"][0]), 2400, STEP_S)
        still = np.full(len(test.t_s), 22.0)
        return replace(test, values={**test.values, "T_nut_X": still, "dZ": test.values["dZ"] - screw})

    return replace(data, tests=tuple(changed(t) for t in data.tests))


def confirmed(data: Dataset) -> Confirmation:
    opened, locked = ([t for t in data.tests if (t.role == "locked") is lock] for lock in (False, True))
    return confirm(base(), 0, data, [SCREW], opened, locked)


def test_a_test_in_which_it_rests_is_not_asked() -> None:
    one = confirmed(machine("t6"))
    assert one.acts == {("c", "t5")}
    where = one.where_it_acts
    assert where is not None
    assert where.holds
    assert where.after < 0.2 * where.before
    both = confirmed(machine())
    assert both.acts == {("c", "t5"), ("c", "t6")}
    assert both.where_it_acts is not None
    assert both.where_it_acts.before == pytest.approx(both.shape_before)


def test_locked_tests_in_which_it_rests_say_nothing() -> None:
    none = confirmed(machine("t5", "t6"))
    assert none.acts == frozenset()
    assert none.where_it_acts is None
    assert none.before is not None, "the errors are known all the same"
