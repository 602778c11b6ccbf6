"""What a model has, by what it does (question/present.py), and what its columns depend on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.diagnosis.question.known_effects import from_other_zero, remembered
from thermodata.diagnosis.question.present import ALL_MODES, Present, modes, present
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.model_file.transfer.as_effect import FreeFunction, GivenFunction
from thermodata.modelling.terms.acting import acting, moved_while
from thermodata.schema.files.model import EffectSpec, Model

from .conftest import make_data


def frame_in(spec: Model) -> Model:
    """A model whose one effect is the spec's model."""
    inside = spec.model_dump(mode="json", by_alias=True)
    return spec.model_copy(update={"effects": [EffectSpec(effect="model", name="frame", gain=1.0, inside=inside)]})


def test_the_effects_of_a_model_inside_of_a_model_are_there(spec: Model) -> None:
    (response,) = fit_model(frame_in(spec), make_data(), uncertainty=False).responses
    assert present(response) == [Present("spindle_bearing", frozenset({"T_bearing"}), "spindle")]


def test_a_function_of_some_phases_is_not_the_whole_effect(spec: Model) -> None:
    heats = EffectSpec(effect="transfer_function", drivers={"u": "T_bearing"}, orders=(2, 2), phases=["heating"])
    (response,) = fit_model(spec.model_copy(update={"effects": [heats]}), make_data(), uncertainty=False).responses
    assert present(response) == [Present("transfer_function", frozenset({"T_bearing"}), "generic", 2, whole=False)]


def test_modes_are_time_constants_and_a_printed_function_lacks_none() -> None:
    assert modes(FreeFunction("varpro", (2, 1))) == 1
    assert modes(FreeFunction("oe", (2, 2))) == 2
    assert modes(GivenFunction([1.0], [60.0, 1.0], None)) == ALL_MODES


def test_what_tells_the_phases_and_what_an_inner_model_reads_change_the_columns(spec: Model) -> None:
    heats = spec.effects[0].model_copy(update={"phases": ["heating"]})
    for model, channel in (
        (spec.model_copy(update={"effects": [heats]}), "spindle_speed"),
        (frame_in(spec), "T_bearing"),
    ):
        data = make_data(tests=4)
        (response,) = fit_model(model, data, uncertainty=False).responses
        test = data.tests[0]
        moved = replace(test, values={**test.values, channel: np.roll(test.values[channel], 90)})
        base = remembered(response)
        assert not np.array_equal(base(test), base(moved))
        np.testing.assert_array_equal(base(moved), remembered(response)(moved))
        assert channel in response.terms[0].bound.reads(test)


def test_an_effect_of_some_phases_answers_to_another_temperature_in_these_only(spec: Model) -> None:
    cools = spec.effects[0].model_copy(update={"phases": ["cooling"]})
    data = make_data(tests=4)
    (whole,) = fit_model(spec, data, uncertainty=False).responses
    (part,) = fit_model(spec.model_copy(update={"effects": [cools]}), data, uncertainty=False).responses
    test = next(t for t in data.tests if (where := acting(t, ["cooling"])) is not None and where.any())
    other = from_other_zero(part, 0, "T_hall", test)
    cooling = acting(test, ["cooling"])
    assert other is not None
    assert cooling is not None
    np.testing.assert_allclose(np.diff(other)[~cooling[1:]], 0.0, atol=1e-12)
    assert from_other_zero(whole, 0, "T_hall", test) is not None
    np.testing.assert_allclose(other, moved_while(other[:, None], cooling)[:, 0])
