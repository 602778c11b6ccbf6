"""A claim says which locked tests could not be asked about it: their silence is no evidence."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thermodata.diagnosis.answer import answer
from thermodata.effect import effects
from thermodata.modelling.fit.model import fit_model
from thermodata.report.verdict.verdict import verdict_sentence
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset, TestData

from .conftest import make_data
from .test_answer import of_nut


def without(test: TestData, channel: str) -> TestData:
    kept = {name: values for name, values in test.values.items() if name != channel}
    return replace(test, values=kept, valid={name: test.valid[name] for name in kept})


def lacking(*channels: str | None) -> Dataset:
    """The last tests are locked, and each lacks a channel."""
    data = make_data(of_nut, tests=6 + len(channels))
    tests = [
        replace(t if c is None else without(t, c), role="locked") for t, c in zip(data.tests[6:], channels, strict=True)
    ]
    return replace(data, tests=(*data.tests[:6], *tests))


@pytest.mark.parametrize(
    ("channels", "why", "head"),
    [
        (
            ("T_bearing",),
            {"t6": "no driver for spindle_bearing (T_bearing)"},
            "; no locked test bears it out, for none could be asked (t6: no driver for spindle_bearing (T_bearing))",
        ),
        (
            ("T_nut_X",),
            {"t6": "no driver for feed_screw (T_nut_X)"},
            "; no locked test bears it out, for none could be asked (t6: no driver for feed_screw (T_nut_X))",
        ),
        (
            ("dZ", None),
            {"t6": "no 'dZ'"},
            "; 1 locked test could not be asked (t6: no 'dZ'): see",
        ),
        ((None,), {}, ""),
    ],
)
def test_a_claim_says_which_locked_tests_could_not_be_asked(
    spec: Model, channels: tuple[str | None, ...], why: dict[str, str], head: str
) -> None:
    data = lacking(*channels)
    found = answer(fit_model(spec, data, uncertainty=False), data, effects(), "m").diagnosis
    assert [c.id for c in found.candidates if c.claimed] == ["feed_screw:T_nut_X"]
    assert {one.test: one.why for one in found.locked_unasked} == why
    said = verdict_sentence(found)
    assert head in said
    assert ("could" in said) is bool(head)


def test_a_claim_says_that_no_test_is_locked(spec: Model) -> None:
    data = make_data(of_nut, tests=7)
    data = replace(data, tests=data.tests[:-1])  # the last is the locked one
    found = answer(fit_model(spec, data, uncertainty=False), data, effects(), "m").diagnosis
    assert [c.id for c in found.candidates if c.claimed] == ["feed_screw:T_nut_X"]
    assert found.locked_tests == 0
    assert "; no locked test bears it out, for none is locked: measure one more" in verdict_sentence(found)
    # an answer of an older version does not know how many there were
    assert "is locked" not in verdict_sentence(found.model_copy(update={"locked_tests": None}))
