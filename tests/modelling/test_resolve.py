"""A model file that does not fit the data is refused with what would."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from thermodata.errors import UsageError
from thermodata.modelling.model_file.resolve import resolve, term_ids
from thermodata.modelling.versions.candidate import candidate_spec, note_of_response, with_effect
from thermodata.schema.files.model import EffectSpec
from thermodata.view.grid.dataset import ChannelInfo, Dataset

from .conftest import Spec


def _more(world: Dataset, **infos: ChannelInfo) -> Dataset:
    """The world with further channels (copies of T_hall)."""
    tests = tuple(
        replace(t, channels={**t.channels, **infos}, values={**t.values, **dict.fromkeys(infos, t.values["T_hall"])})
        for t in world.tests
    )
    return replace(world, tests=tests, channels={**world.channels, **infos})


def test_drivers_are_found_by_place_and_by_name(world: Dataset, spec: Spec) -> None:
    model = spec(
        "spindle_bearing",
        {"effect": "lag", "drivers": {"u": {"at": "axis.z.nut"}}},
        {"effect": "lag", "drivers": {"u": "T_nut - T_hall"}},
    )
    _, (response,) = resolve(model, world)
    assert response.name == "dZ"
    assert [(t.id, dict(t.binding), t.family) for t in response.terms] == [
        ("spindle_bearing", {"temperature": "T_bearing"}, "spindle"),
        ("lag", {"u": "T_nut"}, "generic"),
        ("lag_2", {"u": "T_nut - T_hall"}, "generic"),
    ]


def test_roles_come_from_the_tests_or_from_the_file(world: Dataset, spec: Spec) -> None:
    roles, _ = resolve(spec(), world)
    assert [len(r) for r in (roles.calibrate, roles.verify, roles.locked)] == [5, 2, 1]
    roles, _ = resolve(spec(calibrate_on=["t6"], verify_on=["c/t0"]), world)
    assert roles.calibrate == (("c", "t6"),)
    assert roles.role(("c", "t0")) == "verification"
    assert roles.role(("c", "t5")) == "none"
    # a test that one list names leaves its own role
    roles, _ = resolve(spec(calibrate_on=["t6"]), world)
    assert roles.verify == (("c", "t5"),)


@pytest.mark.parametrize(
    ("effects", "more", "says"),
    [
        (["spindle_bering"], {}, "spindle_bearing'"),
        ([{"effect": "lag", "drivers": {"u": "T_nuts"}}], {}, "did you mean 'T_nut'"),
        ([{"effect": "lag", "drivers": {"u": "T_nut - T_amb"}}], {}, "no channel 'T_amb'"),
        ([{"effect": "lag", "drivers": {"v": "T_nut"}}], {}, "no driver role 'v'"),
        ([{"effect": "lag", "drivers": {"u": {"at": "axis.x"}}}], {}, "no channels lie at 'axis.x'"),
        (["lag"], {}, "several channels fit"),
        (["tool_elongation"], {}, "temperature at tool"),
        ([{"effect": "spindle_bearing", "fixed": {"tua": 3.0}}], {}, "did you mean 'tau'"),
        ([{"effect": "spindle_bearing", "orders": [2, 2]}], {}, "belongs to transfer_function"),
        ([{"effect": "spindle_bearing", "tests": ["t99"]}], {}, "no test 't99'"),
        ([{"effect": "spindle_bearing", "calibrate_on": ["etve"]}], {}, "no test 'etve'"),
        ([{"effect": "prediction"}], {}, "needs 'file'"),
        (
            [
                {"effect": "lag", "id": "a", "drivers": {"u": "T_nut"}},
                {"effect": "lag", "id": "a", "drivers": {"u": "T_hall"}},
            ],
            {},
            "two effects have the id",
        ),
        ([], {"calibrate_on": ["t0"], "verify_on": ["t0"]}, "two roles"),
        ([], {"calibrate_on": []}, "no test to calibrate on"),
        ([], {"response": {"axis": "X", "at": "tcp"}}, "dZ (axis Z"),
        ([], {"response": {"channel": "dz1"}}, "no channel 'dz1'"),
        ([{"effect": "spindle_bearing", "gain_by": "conditions.tool"}], {}, "no condition 'tool'"),
    ],
)
def test_what_does_not_fit_is_refused(
    world: Dataset, spec: Spec, effects: list[Any], more: dict[str, Any], says: str
) -> None:
    from thermodata.modelling import fit_model

    with pytest.raises(UsageError) as caught:
        fit_model(spec(*effects, **more), world)
    assert says in str(caught.value)


def test_two_sensors_that_fit_are_an_error_that_names_both(world: Dataset, spec: Spec) -> None:
    data = _more(world, T_low=ChannelInfo("T_low", "temperature", "degC", "hall.bottom"))
    with pytest.raises(UsageError) as caught:
        resolve(spec("ambient_frame"), data)
    assert "temperature: T_hall" in str(caught.value)
    assert "temperature: T_low" in str(caught.value)
    _, (response,) = resolve(spec({"effect": "ambient_frame", "drivers": {"temperature": "T_low"}}), data)
    assert dict(response.terms[0].binding) == {"temperature": "T_low"}


def test_two_responses_that_fit_are_an_error(world: Dataset, spec: Spec) -> None:
    data = _more(world, dZ2=ChannelInfo("dZ2", "displacement", "um", "tcp", "Z"))
    with pytest.raises(UsageError, match="dZ2"):
        resolve(spec(), data)
    _, (response,) = resolve(spec(response={"channel": "dZ2"}), data)
    assert response.name == "dZ2"


def test_a_place_below_is_taken_where_none_is_exact(world: Dataset, spec: Spec) -> None:
    data = _more(world, dZ_far=ChannelInfo("dZ_far", "displacement", "um", "table.d1500", "Z"))
    _, (response,) = resolve(spec(response={"axis": "Z", "at": "table"}), data)
    assert response.name == "dZ_far"


def test_campaigns_may_name_the_same_place_differently(world: Dataset, spec: Spec) -> None:
    names = {"T_bearing": "Lager", "dZ": "Z1"}

    def rename(d: Any) -> Any:
        return {names.get(k, k): v for k, v in d.items()}

    other = tuple(
        replace(
            t,
            campaign="d",
            values=rename(t.values),
            valid=rename(t.valid),
            channels={names.get(n, n): replace(i, name=names.get(n, n)) for n, i in t.channels.items()},
        )
        for t in world.tests
    )
    data = replace(world, tests=world.tests + other)
    model = spec("spindle_bearing", campaign=None, campaigns=["c", "d"], calibrate_on=["c/t0", "d/t1"])
    _, (response,) = resolve(model, data)
    assert response.terms[0].bindings == {"c": {"temperature": "T_bearing"}, "d": {"temperature": "Lager"}}
    assert response.channel_of(other[0]) == "Z1"
    with pytest.raises(UsageError, match="several campaigns"):
        resolve(spec(campaign=None, campaigns=["c", "d"], calibrate_on=["t0"]), data)


def test_ids_are_numbered_and_never_collide() -> None:
    specs = [
        EffectSpec(effect="spindle_bearing"),
        EffectSpec(effect="spindle_bearing"),
        EffectSpec(effect="spindle_bearing_2"),
        EffectSpec(effect="lag", id="spindle_bearing_3"),
    ]
    assert len(set(term_ids(specs))) == 4


def test_a_candidate_becomes_a_line_of_the_model_file(world: Dataset, spec: Spec) -> None:
    effect = candidate_spec("feed_screw:T_nut", world.channels)
    assert effect == EffectSpec(effect="feed_screw", drivers={"temperature": "T_nut"})
    assert candidate_spec("feed_screw", world.channels) == effect
    grown = with_effect(spec("spindle_bearing"), effect)
    assert [e.effect for e in grown.effects] == ["spindle_bearing", "feed_screw"]
    assert grown.in_sample
    # a channel without a fitting place, named on purpose
    assert candidate_spec("tool_elongation:T_nut", world.channels).drivers == {"temperature": "T_nut"}
    for wrong in ("feed_screw:T_nutt", "feed_srew:T_nut", "lag", "vertical_gradient:T_hall"):
        with pytest.raises(UsageError):
            candidate_spec(wrong, world.channels)


def test_an_effect_of_a_plugin_that_is_not_installed_says_so_and_whose_it_is(world: Dataset, spec: Spec) -> None:
    model = spec({"effect": "guide_heat", "id": "guide", "drivers": {"u": "T_nut"}})
    with pytest.raises(UsageError, match="no effect 'guide_heat'") as error:
        resolve(model, world)
    assert error.value.where == f"model '{model.name}', effect 'guide'"
    assert "if a plugin has it that is not installed here" in (error.value.hint or "")


def test_a_displacement_or_tilt_as_a_driver_is_told_to_be_no_cause() -> None:
    channels = {n: ChannelInfo(n, q, "um") for n, q in (("ch4", "displacement"), ("T", "temperature"))}
    told = note_of_response(["ch4", "T"], channels) or ""
    assert told.startswith("ch4 is itself a displacement or tilt: a response")
    assert note_of_response(["T", "gone"], channels) is None


def test_an_effect_that_no_channel_fits_says_what_it_needs() -> None:
    infos = {"T_hall": ChannelInfo("T_hall", "temperature", "degC", "hall.bottom")}
    with pytest.raises(UsageError) as refused:
        candidate_spec("sun", infos)
    said = str(refused.value)
    assert "no channel fits what 'sun' needs" in said
    assert "irradiance: irradiance at hall" in said
    assert "sun:CHANNEL" in said
