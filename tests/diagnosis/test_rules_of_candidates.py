"""What may be asked for, and within which bounds (diagnosis/candidates.py)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.candidates import CandidateEffect, candidates, grid
from thermodata.plugin import Effect, Gain, Need, Param
from thermodata.view.dataset import ChannelInfo

from .hand_made import PlainEffect

CHANNELS = {
    c.name: c
    for c in (
        ChannelInfo("dZ", "displacement", "um", at="tcp"),
        ChannelInfo("dX", "displacement", "um", at="tcp"),
        ChannelInfo("tilt", "tilt", "urad", at="tcp"),
        ChannelInfo("program", "label", "1"),
        ChannelInfo("T_nut", "temperature", "degC", at="axis.x.nut"),
        ChannelInfo("T_oil", "temperature", "degC", at="hydraulics"),
        ChannelInfo("T_free", "temperature", "degC"),
    )
}
NUT = PlainEffect("screw", "feed_x", needs=(Need("u", "temperature", ("axis.x.nut",)),))
LAG = PlainEffect("lag", "generic", needs=(Need("u", "*"),))
REFINED = replace(NUT, name="screw_lead", refines=("screw",))


def asked(*library: Effect, present: tuple[tuple[str, frozenset[str]], ...] = (), response: str = "dZ") -> list[str]:
    return [c.id for c in candidates({e.name: e for e in library}, CHANNELS, present, response)]


def has(effect: str, *channels: str) -> tuple[str, frozenset[str]]:
    return effect, frozenset(channels)


def test_a_plain_lag_stands_for_channels_that_no_named_effect_covers() -> None:
    assert asked(NUT, LAG) == ["screw:T_nut", "lag:T_oil", "lag:T_free"]
    assert asked(LAG) == ["lag:T_nut", "lag:T_oil", "lag:T_free"]
    assert asked(NUT, LAG, present=(has("spindle", "T_oil"),)) == ["screw:T_nut", "lag:T_free"]


def test_neither_displacements_nor_labels_nor_the_response_drive_anything() -> None:
    assert not {"lag:dX", "lag:dZ", "lag:tilt", "lag:program"} & set(asked(LAG))
    assert "lag:T_oil" not in asked(LAG, response="T_oil")


def test_what_the_model_has_is_not_asked_for() -> None:
    assert asked(NUT, present=(has("screw", "T_nut"),)) == []
    assert asked(NUT, present=(has("screw", "T_oil"),)) == ["screw:T_nut"], "by other channels it may be missing"


def test_a_channel_that_the_model_lags_already_is_not_asked_for_by_name() -> None:
    assert asked(NUT, LAG, present=(has("lag", "T_nut"),)) == ["lag:T_oil", "lag:T_free"]
    assert asked(NUT, present=(has("not_in_the_library", "T_nut"),)) == []


def test_a_refinement_is_asked_for_where_the_model_has_what_it_refines_on_the_same_channel() -> None:
    spindle = PlainEffect("spindle", "spindle", needs=(Need("u", "rotational_speed"),))
    assert asked(REFINED) == []
    assert asked(NUT, REFINED, present=(has("screw", "T_nut"),)) == ["screw_lead:T_nut"]
    assert asked(NUT, REFINED, present=(has("screw", "T_oil"),)) == ["screw:T_nut"]
    assert asked(spindle, REFINED, present=(has("spindle", "T_nut"),)) == []


def test_artefacts_and_effects_without_drivers_are_no_candidates() -> None:
    assert asked(replace(NUT, family="artefact"), replace(NUT, name="drift", needs=())) == []


def test_only_a_lag_of_a_channel_without_a_place_is_placeless() -> None:
    library = {e.name: e for e in (LAG, replace(NUT, name="anywhere", needs=(Need("u", "temperature"),)))}
    free = {"T_free": CHANNELS["T_free"], "F": ChannelInfo("F", "flow", "l/min"), "T_oil": CHANNELS["T_oil"]}
    found = {c.id: c.placeless for c in candidates(library, free, (), "dZ")}
    assert found == {"anywhere:T_free": False, "anywhere:T_oil": False, "lag:F": True}


def bound(sign: str) -> CandidateEffect:
    gain = Gain("gain", "um/K", (1.0, 10.0), sign, "")  # type: ignore[arg-type]
    return CandidateEffect(replace(NUT, gains=(gain,)), {"u": "T_nut"}, "feed_x")


@pytest.mark.parametrize(("sign", "lower", "upper"), [("any", -15.0, 15.0), ("+", 0.0, 15.0), ("-", -15.0, 0.0)])
def test_a_gain_stays_within_1_5_times_what_is_plausible_and_its_sign(sign: str, lower: float, upper: float) -> None:
    priors = bound(sign).priors
    assert (priors.spread.tolist(), priors.lower.tolist(), priors.upper.tolist()) == ([15.0], [lower], [upper])


def test_a_distributed_machine_acts_five_times_faster_and_slower() -> None:
    params = (Param("tau", "min", 30, 1, 360, ""), Param("p", "1", 1.5, 1, 2.5, ""), Param("lead", "s", 5, 1, 9, ""))
    effect = CandidateEffect(replace(NUT, params=params), {"u": "T_nut"}, "feed_x")
    slack = effect.slack_params({"tau": 10.0, "p": 2.0, "lead": 5.0})
    assert [(p["tau"], p["p"], p["lead"]) for p in slack] == [
        (2.0, 2.0, 5.0),
        (50.0, 2.0, 5.0),
        (10.0, 2.0, 1.0),
        (10.0, 2.0, 25.0),
    ]


@pytest.mark.parametrize(("count", "points"), [(0, 1), (1, 10), (2, 25), (3, 27)])
def test_the_grid_is_finer_the_fewer_parameters_there_are(count: int, points: int) -> None:
    assert len(grid([Param(f"tau{i}", "min", 30, 1, 360, "") for i in range(count)], 60.0)) == points


def test_the_grid_keeps_to_the_bounds_and_to_what_a_sample_resolves() -> None:
    taus = [p["tau"] for p in grid([Param("tau", "min", 30, 0.1, 360, "")], 120.0)]
    assert (taus[0], taus[-1]) == (pytest.approx(0.5), pytest.approx(360.0))
    np.testing.assert_allclose(np.diff(np.log(taus)), np.log(720) / 9)
    wide = [p["k"] for p in grid([Param("k", "1", 1, 1.0, 10.1, "")], 60.0)]
    assert wide[1] / wide[0] == pytest.approx(wide[-1] / wide[-2])
    narrow = [p["k"] for p in grid([Param("k", "1", 1, 1.0, 9.9, "")], 60.0)]
    assert narrow == pytest.approx(np.linspace(1.0, 9.9, 4))
