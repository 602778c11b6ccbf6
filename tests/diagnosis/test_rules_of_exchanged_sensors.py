"""Two temperatures that are exchanged in a test are told, where the other tests tell them apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.sensors.exchanged import (
    _look_exchanged,
    _of_pair,
    _suspects,
    exchanged_sensors,
    exchanges,
    is_exchanged,
)
from thermodata.diagnosis.sensors.temperature_sums import TemperatureSums
from thermodata.effect import effects
from thermodata.modelling.fit.model import fit_model
from thermodata.report.verdict.log_faults import log_faults
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset

from .test_rules_of_loose_sensors import machine

FRONT, NUT = "T_front", "T_nut"


def exchanged(data: Dataset, tests: Sequence[int], a: str = FRONT, b: str = NUT) -> Dataset:
    """The two as if their cables were exchanged in some tests."""

    def turned(i: int) -> dict[str, np.ndarray]:
        values = data.tests[i].values
        return {**values, a: values[b], b: values[a]}

    return replace(
        data, tests=tuple(replace(t, values=turned(i)) if i in tests else t for i, t in enumerate(data.tests))
    )


def test_two_that_are_exchanged_in_a_test_are_told_with_what_to_write() -> None:
    [told] = exchanged_sensors(exchanged(machine(), [3]), "dZ")
    assert (told.kind, told.campaign, told.test, told.at_s, told.size_um) == ("exchanged", "c", "t3", None, None)
    assert "there 'T_front' does what commands and other temperatures foretell of 'T_nut'" in told.why
    assert "and 7 tests have them the other way round" in told.why
    assert "channels: {T_front: {signal: ...}, T_nut: {signal: ...}}" in told.why


def test_a_sound_machine_has_none() -> None:
    assert exchanged_sensors(machine(), "dZ") == []


def test_of_several_tests_it_is_said_once() -> None:
    found = exchanged_sensors(exchanged(machine(), [2, 5]), "dZ")
    assert [a.test for a in found] == ["t2", "t5"]
    [fault] = log_faults(found)
    assert fault.where == ["t2", "t5"]


def test_most_tests_are_taken_for_right_and_of_halves_nobody_knows() -> None:
    """From the third test on exchanged: the two before are the odd ones, and the sentence says that it may be those."""
    found = exchanged_sensors(exchanged(machine(), range(2, 8)), "dZ")
    assert [a.test for a in found] == ["t0", "t1"]
    assert "look whether their cables were exchanged, there or in those" in found[0].why
    assert exchanged_sensors(exchanged(machine(), range(4, 8)), "dZ") == []


def test_two_on_one_body_are_as_good_as_each_other() -> None:
    """Two that read the same nothing tells."""
    data = machine()
    same = replace(data, tests=tuple(replace(t, values={**t.values, NUT: t.values[FRONT] + 0.01}) for t in data.tests))
    assert exchanged_sensors(exchanged(same, [3]), "dZ") == []


def test_a_test_at_rest_tells_nothing() -> None:
    data = machine()
    rest = dict.fromkeys((FRONT, NUT, "T_rear"), data.tests[3].values["T_hall"])
    still = {"speed": np.zeros_like(rest[NUT]), "feed": np.zeros_like(rest[NUT])}
    quiet = replace(data.tests[3], values={**data.tests[3].values, **rest, **still})
    resting = replace(data, tests=(*data.tests[:3], quiet, *data.tests[4:]))
    assert exchanged_sensors(exchanged(resting, [3]), "dZ") == []


def test_one_that_failed_is_not_exchanged() -> None:
    """One that stands still fits nothing better under another name."""
    data = machine()
    stuck = {**data.tests[3].values, FRONT: np.full_like(data.tests[3].values[FRONT], 30.0)}
    one = replace(data.tests[3], values=stuck)
    assert exchanged_sensors(replace(data, tests=(*data.tests[:3], one, *data.tests[4:])), "dZ") == []


@pytest.mark.parametrize(("tests", "found"), [(2, 0), (3, 0), (4, 1)])
def test_other_tests_have_to_tell_them_apart(tests: int, found: int) -> None:
    data = machine()
    few = replace(data, tests=data.tests[:tests])
    assert len(exchanges(exchanged(few, [1]), exchanged(few, [1]).tests)) <= found
    if found:
        assert [e.test.test for e in exchanges(exchanged(few, [1]), exchanged(few, [1]).tests)] == ["t1"]


@pytest.mark.parametrize(
    ("straight", "turned", "energy", "holds"),
    [
        ((400.0, 400.0), (40.0, 40.0), (500.0, 500.0), True),
        ((400.0, 400.0), (90.0, 90.0), (500.0, 500.0), False),  # it falls by less than 80 %
        ((700.0, 100.0), (20.0, 60.0), (900.0, 200.0), False),  # one alone is better: the other failed, say
        ((400.0, 400.0), (60.0, 60.0), (150.0, 150.0), False),  # of what is left nobody foretells enough
        ((20.0, 20.0), (2.0, 2.0), (30.0, 30.0), False),  # less than half a kelvin is left of both
    ],
)
def test_how_plain_it_has_to_be(
    straight: tuple[float, float], turned: tuple[float, float], energy: tuple[float, float], holds: bool
) -> None:
    """Squared errors of two in 100 rows."""
    assert is_exchanged(np.array(straight), np.array(turned), np.array(energy), 100) == holds


def test_each_machine_by_itself() -> None:
    """Tests of two campaigns say nothing of each other's cables."""
    data = exchanged(machine(), [3])
    other = tuple(replace(t, campaign="d") for t in exchanged(machine(), range(8)).tests)
    found = exchanged_sensors(replace(data, tests=(*data.tests, *other)), "dZ")
    assert [(a.campaign, a.test) for a in found] == [("c", "t3")]


def test_the_answer_tells_it() -> None:
    data = exchanged(machine(), [3])
    rng = np.random.default_rng(5)
    tests = tuple(
        replace(
            t, values={**t.values, "dZ": 2.0 * (t.values["T_rear"] - t.values["T_rear"][0]) + rng.normal(0, 0.1, 300)}
        )
        for t in data.tests
    )
    data = replace(data, tests=tests)
    spec = Model.model_validate(
        {
            "schema": "thermodata/model/1",
            "name": "m",
            "campaign": "c",
            "response": {"axis": "Z", "at": "tcp"},
            "step": "60 s",
            "effects": [{"effect": "spindle_bearing", "drivers": {"temperature": "T_rear"}}],
        }
    )
    found = answer(fit_model(spec, data, uncertainty=False), data, effects(), "m").diagnosis
    assert [(a.kind, a.test) for a in found.artefacts if a.kind == "exchanged"] == [("exchanged", "t3")]


@pytest.mark.parametrize("missing", [False, True])
def test_all_pairs_at_once_say_what_each_says_alone(missing: bool) -> None:
    """By blocks of one inverse, or by a solution for each pair; one may not be measured in all tests."""
    data = exchanged(exchanged(machine(), [3]), [5], "T_rear", NUT)
    if missing:
        gone = {n: v for n, v in data.tests[6].values.items() if n != "T_rear"}
        data = replace(data, tests=(*data.tests[:6], replace(data.tests[6], values=gone), *data.tests[7:]))
    sums = TemperatureSums(data, data.tests, "dZ")
    pairs = [(a, b) for a in range(len(sums.names)) for b in range(a + 1, len(sums.names))]
    told = {pair for pair in pairs if _of_pair(sums, *pair)}
    assert told
    assert told <= set(_suspects(sums)) < {*pairs, (-1, -1)}


def test_what_is_left_of_a_pair_is_what_a_solution_leaves() -> None:
    rng = np.random.default_rng(2)
    parts = [rng.normal(size=(60, 5)) @ rng.normal(size=(5, 5)) for _ in range(4)]
    for part in parts[:1]:
        part[:, [3, 4]] = part[:, [4, 3]]
    gram = np.stack([x.T @ x for x in parts])
    size = np.sqrt(np.einsum("tkk->k", gram))
    looks = _look_exchanged(gram / size[:, None] / size, size, np.array([[3, 4]]), np.full(4, 60))
    by, both = np.arange(3), np.array([3, 4])
    alone = []
    for t in range(4):
        others = np.delete(gram, t, axis=0).sum(axis=0)
        ridge = 0.01 * np.diag(size[by] ** 2)
        gains = np.linalg.solve(others[np.ix_(by, by)] + ridge, others[np.ix_(by, both)])
        said = parts[t][:, by] @ gains
        straight = ((parts[t][:, both] - said) ** 2).sum(axis=0)
        turned = ((parts[t][:, both[::-1]] - said) ** 2).sum(axis=0)
        alone.append(bool(is_exchanged(straight, turned, (parts[t][:, both] ** 2).sum(axis=0), 60)))
    assert looks.tolist() == [any(alone)]
