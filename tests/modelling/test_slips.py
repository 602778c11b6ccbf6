"""Slips of a probe that a diagnosis told, taken out by name."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thermodata.errors import SpecError, UsageError
from thermodata.modelling import run
from thermodata.modelling.add import add
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.versions.slips import lines_of_test, with_lines
from thermodata.schema.answers.diagnosis import Artefact, Diagnosis
from thermodata.schema.answers.slip_ids import slip_ids
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import save_diagnosis
from thermodata.store.catalogue.models.fits import find_model
from thermodata.view.grid.dataset import Dataset

from ..answers import diagnosis
from .conftest import Spec, Stored

SLIP = Artefact(kind="step", campaign="c", test="t2", at_s=4 * 3600.0, size_um=14.04, why="")


def with_steps(*artefacts: Artefact, **more: str) -> Diagnosis:
    return diagnosis(artefacts=list(artefacts), verdict="none", **more)


def slipped(world: Dataset, size: float = 14.0) -> Dataset:
    """The probe slips after four hours in one of the tests."""
    tests = [
        replace(t, values={**t.values, "dZ": t.values["dZ"] + size * (t.t_s >= SLIP.at_s)}) if t.test == "t2" else t
        for t in world.tests
    ]
    return replace(world, tests=tuple(tests))


@pytest.fixture(scope="module")
def store(stored: Stored, world: Dataset, tmp_path_factory: pytest.TempPathFactory) -> Store:
    return stored(slipped(world), tmp_path_factory.mktemp("slipped"))


def test_what_was_told_of_a_test_is_taken_out_of_it_alone(store: Store, spec: Spec) -> None:
    parent = run.fit(store, spec("spindle_bearing", "feed_screw", "ambient_frame", "centrifugal_shift", "coolant"))
    save_diagnosis(store, parent.model, with_steps(SLIP, model=parent.model))
    grown = add(store, parent.model, "step:t2")
    line = find_model(store, grown.model).spec.effects[-1]
    assert (line.effect, line.tests, line.fixed) == ("step", ["c/t2"], {"at": 240.0, "gain": 14.0})
    assert (grown.added, grown.notes) == (["step"], []), "no second lag is asked for"
    of = {(s.role, s.test): s.rmse_um for s in grown.scores if s.phase == "all"}
    before = {(s.role, s.test): s.rmse_um for s in grown.before or () if s.phase == "all"}
    assert set(of) == set(before), "verification tests took no part in it, and stay what they were"
    with pytest.raises(UsageError, match="is in the model already"):
        add(store, parent.model, "step:t2", "step:c/t2")
    assert (of["calibration", "t2"] or 9.0) < 0.5 < 2.0 < (before["calibration", "t2"] or 0.0)


def test_a_slip_in_one_of_several_campaigns_is_named_with_its_campaign() -> None:
    other = SLIP.model_copy(update={"campaign": "d"})
    assert slip_ids(with_steps(SLIP)) == ["step:t2"]
    assert slip_ids(with_steps(SLIP, other)) == ["step:c/t2", "step:d/t2"]


def test_two_slips_of_a_test_are_two_lines(spec: Spec, world: Dataset) -> None:
    later = SLIP.model_copy(update={"at_s": 6 * 3600.0, "size_um": -3.0})
    other = SLIP.model_copy(update={"test": "t3"})
    lines = lines_of_test("step:t2", spec("spindle_bearing"), world, with_steps(SLIP, other, later), ["dZ"])
    assert [(e.tests, e.fixed) for e in lines] == [
        (["c/t2"], {"at": 240.0, "gain": 14.0}),
        (["c/t2"], {"at": 360.0, "gain": -3.0}),
    ]
    assert fit_model(with_lines(spec("spindle_bearing"), lines), world, uncertainty=False).responses


def test_a_slip_is_that_of_the_response_that_was_diagnosed(spec: Spec, world: Dataset) -> None:
    both = spec("spindle_bearing", response=[{"axis": "X", "at": "tcp"}, {"axis": "Z", "at": "tcp"}])
    (line,) = lines_of_test("step:t2", both, world, with_steps(SLIP), ["dX", "dZ"])
    assert line.acts_on == [both.responses[1]]
    shared = spec({"effect": "spindle_bearing", "gain_by": "place"}, response=[{"channel": "dX"}, {"channel": "dZ"}])
    (line,) = lines_of_test("step:t2", shared, world, with_steps(SLIP), ["dX", "dZ"])
    assert (line.acts_on, line.gain_by, set(line.fixed)) == (None, "place", {"at"})


def test_a_drift_belongs_to_its_test_too(spec: Spec, world: Dataset) -> None:
    (line,) = lines_of_test("drift:t1", spec("spindle_bearing"), world, None, ["dZ"])
    assert (line.effect, line.tests) == ("drift", ["c/t1"])
    assert lines_of_test("feed_screw:T_nut", spec("spindle_bearing"), world, None, ["dZ"]) == []


@pytest.mark.parametrize(
    ("candidate", "says"),
    [
        ("step", "'step' is a fault of one probe in one test; expected: step:t2"),
        ("drift", "'drift' is a fault of one probe in one test; expected: drift:TEST"),
        ("step:t3", "no step was told of test 't3'; expected: step:t2"),
    ],
)
def test_what_names_no_slip_that_was_told_is_refused(spec: Spec, world: Dataset, candidate: str, says: str) -> None:
    with pytest.raises(UsageError) as refused:
        lines_of_test(candidate, spec("spindle_bearing"), world, with_steps(SLIP), ["dZ"])
    assert says in " ".join(str(refused.value).replace("\n", "; ").split())


def test_a_test_that_there_is_not_is_refused(spec: Spec, world: Dataset) -> None:
    with pytest.raises((UsageError, SpecError), match="t99"):
        lines_of_test("step:t99", spec("spindle_bearing"), world, with_steps(SLIP), ["dZ"])
