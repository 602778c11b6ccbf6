"""Faults of the logs that look like physics: clocks and turned probes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.diagnosis.answer import answer
from thermodata.effect import effects
from thermodata.modelling.fit.model import fit_model
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset

from .conftest import make_data


def artefacts(data: Dataset, spec: Model) -> list[Artefact]:
    return answer(fit_model(spec, data, uncertainty=False), data, effects(), "m").diagnosis.artefacts


def of_two_sources(data: Dataset) -> Dataset:
    sources = {n: replace(c, source="daq" if n == "dZ" else "nc") for n, c in data.channels.items()}
    return replace(data, channels=sources)


def test_a_clock_that_is_off_in_every_test_is_named_with_its_source(spec: Model) -> None:
    data = of_two_sources(make_data())
    late = tuple(
        replace(t, values={n: v if n == "dZ" else np.interp(t.t_s - 300.0, t.t_s, v) for n, v in t.values.items()})
        for t in data.tests
    )
    moved = [a for a in artefacts(replace(data, tests=late), spec) if a.kind == "clock_offset"]
    assert len(moved) == 1
    assert "source 'nc'" in moved[0].why
    assert "-5 min" in moved[0].why


def test_sound_logs_have_no_fault(spec: Model) -> None:
    assert artefacts(of_two_sources(make_data()), spec) == []


def test_what_happens_in_a_hole_is_no_slip(spec: Model) -> None:
    data = make_data()
    test = data.tests[2]
    n = len(test.t_s)
    shifted = test.values["dZ"] + 5.0 * (np.arange(n) >= n // 2 + 10)
    hole = (np.arange(n) >= n // 2) & (np.arange(n) < n // 2 + 20)
    valid = {**test.valid, "dZ": ~hole}
    tests = list(data.tests)
    tests[2] = replace(test, values={**test.values, "dZ": shifted}, valid=valid)
    assert not [a for a in artefacts(replace(data, tests=tuple(tests)), spec) if a.kind == "step"]


def test_parameters_that_do_not_hold_are_named_as_such(spec: Model) -> None:
    wrong = spec.model_copy(
        update={"effects": [spec.effects[0].model_copy(update={"fixed": {"gain": 1.5, "tau": 20.0}})]}
    )
    found = artefacts(make_data(), wrong)
    assert "parameters" in [a.kind for a in found]
