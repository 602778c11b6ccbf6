"""A version of a model heeds what a diagnosis found wrong with the logs."""

from __future__ import annotations

import pytest

from thermodata.modelling.versions.made_without import still_without
from thermodata.modelling.versions.unsound import heeding
from thermodata.schema.answers.diagnosis import ClockMoved, PutRight
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset

from .conftest import CHANNELS, STEP, Spec, make_test


@pytest.fixture
def data() -> Dataset:
    roles = ("calibration", "calibration", "verification", "locked")
    return Dataset(STEP, tuple(make_test(k, role) for k, role in enumerate(roles)), CHANNELS, "v1")


@pytest.fixture
def model(spec: Spec) -> Model:
    return spec("spindle_bearing")


def keys(data: Dataset, *numbers: int) -> list[tuple[str, str]]:
    return [data.tests[k].key for k in numbers]


def named(data: Dataset, *numbers: int) -> list[str]:
    return ["/".join(key) for key in keys(data, *numbers)]


def test_a_test_with_a_turned_probe_takes_no_part(model: Model, data: Dataset) -> None:
    grown, notes = heeding(model, data, PutRight(left_out=keys(data, 1)))
    assert (grown.calibrate_on, grown.verify_on) == (named(data, 0), named(data, 2))
    assert [n.partition(";")[0] for n in notes] == [f"made without {data.tests[1].test}: its probe is turned"]


def test_nor_does_one_whose_clock_is_off_by_itself(model: Model, data: Dataset) -> None:
    campaign, test = data.tests[2].key
    clock = ClockMoved(source="nc", campaign=campaign, test=test, moved_s=3600.0)
    grown, notes = heeding(model, data, PutRight(clocks=[clock]))
    assert (grown.calibrate_on, grown.verify_on) == (named(data, 0, 1), [])
    assert notes == [
        f"made without {test}: the clock of nc is off in it by +60 min, the diagnosis says. If so, declare at this "
        "test clocks: {nc: 3600 s}; if it was right, clocks: {nc: 0 s}; then ingest, and fit again"
    ]


def test_what_to_declare_at_a_test_is_all_that_its_clock_is_moved_by(model: Model, data: Dataset) -> None:
    campaign, test = data.tests[2].key
    of_all = ClockMoved(source="nc", moved_s=-120.0)
    of_one = ClockMoved(source="nc", campaign=campaign, test=test, moved_s=3600.0)
    *_, note = heeding(model, data, PutRight(clocks=[of_all, of_one]))[1]
    assert "clocks: {nc: 3480 s}; if it was right, clocks: {nc: 0 s}" in note


def test_a_clock_that_is_off_in_all_tests_is_told_and_nothing_left_out(model: Model, data: Dataset) -> None:
    same, [note] = heeding(model, data, PutRight(clocks=[ClockMoved(source="nc", moved_s=-3600.0)]))
    assert same is model
    assert note.startswith("the clock of nc is off by -60 min")


@pytest.mark.parametrize("found", [None, PutRight(), PutRight(left_out=[("other", "test")])])
def test_sound_logs_change_nothing(model: Model, data: Dataset, found: PutRight | None) -> None:
    assert heeding(model, data, found) == (model, [])


def test_a_model_keeps_a_test_to_calibrate_on(model: Model, data: Dataset) -> None:
    assert heeding(model, data, PutRight(left_out=keys(data, 0, 1)))[0] is model


def test_what_a_version_was_made_without_is_told_until_it_is_back() -> None:
    old, new = "made without t1: its probe is turned", "made without t1: the clock of nc is off in it"
    chain = [["no second lag", old], ["made without t2: its probe is turned"], [new]]
    assert still_without(chain, ["t3"]) == [new, chain[1][0]]
    assert still_without(chain, ["t1", "t3"]) == [chain[1][0]]
    assert still_without([[]], []) == []
