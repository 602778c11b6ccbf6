"""What other axes of the same place say of a candidate (claims/other_axes.py), and what that does to a claim."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.claims import other_axes
from thermodata.diagnosis.claims.other_axes import OtherAxes, beside, is_same
from thermodata.diagnosis.claims.probability import CLAIMED, may_be_borne_out, probability
from thermodata.diagnosis.claims.rules_together import blunt
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.effect import effects
from thermodata.errors import UsageError
from thermodata.schema.files.model import EffectSpec, Model, Response
from thermodata.view.grid.dataset import ChannelInfo, Dataset

from . import stand_ins
from .conftest import CHANNELS
from .hand_made import candidate, scored

Z = CHANNELS["dZ"]
X, Y = (replace(Z, name=f"d{a}", axis=a) for a in "XY")


def test_one_heat_is_one_by_its_channels_or_by_a_family_that_has_a_name() -> None:
    nut = candidate("feed_screw", family="feed_x", channels=("T_nut",))
    assert is_same(nut, candidate("lag", family="generic", channels=("T_nut",)))
    assert is_same(nut, candidate("feed_screw", family="feed_x", channels=("v",)))
    assert not is_same(nut, candidate("feed_screw", family="feed_z", channels=("v",)))
    for nameless in ("generic", "control"):
        one, other = (candidate("lag", family=nameless, channels=(c,)) for c in ("T_a", "T_b"))
        assert not is_same(one, other)


def test_an_axis_is_one_of_the_same_place_with_a_sound_probe() -> None:
    def of(*others: ChannelInfo) -> list[str]:
        return beside("dZ", {c.name: c for c in (Z, *others)})

    assert of(X, Y) == ["dX", "dY"]
    assert of(replace(X, name="dX2"), X) == ["dX2"], "one for each axis"
    assert of(X, Y, replace(Z, name="rZ", axis="A")) == ["dX", "dY"], "two at most"
    for other in (
        replace(X, at="spindle.stator"),
        replace(X, relative_to="floor"),
        replace(X, quantity="tilt"),
        replace(X, faulty="stuck"),
        replace(X, axis=None),
        replace(Z, name="dZ2"),
    ):
        assert of(other) == []
    assert beside("T", {"T": ChannelInfo("T", "temperature", "degC", at="tcp"), "dX": X}) == []


class Asked:
    """The other axes of a model, fitted to nothing; what is missing there is given by hand."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, spec: Model, there: dict[str, Sequence[Scored]]) -> None:
        self.fits: list[str] = []
        self.there = there

        def fit(asked: Model, *_: Any, **__: Any) -> stand_ins.Fitted:
            channel = str(asked.responses[0].channel)
            self.fits.append(channel)
            if channel not in there:
                raise UsageError("no usable test")
            return stand_ins.Fitted([stand_ins.Response({}, name=channel)], asked)

        monkeypatch.setattr(other_axes, "fit_model", fit)
        data = Dataset(60.0, (), {c.name: c for c in (Z, X, Y)})
        self.axes = OtherAxes(spec, "dZ", data, effects())

    def say(self, one: Scored) -> tuple[tuple[str, float], ...]:
        return self.axes.say(one, lambda response, tests: self.there[response.name])


NUT = scored("feed_screw", evidence=60.0)
SURE, OTHER = scored("lag", family="generic"), scored("coolant", family="coolant", channels=("on",))


def test_each_axis_says_how_sure_it_is_there_and_is_asked_once(monkeypatch: pytest.MonkeyPatch, spec: Model) -> None:
    asked = Asked(monkeypatch, spec, {"dX": [OTHER, SURE], "dY": [OTHER]})
    assert asked.fits == [], "not before it matters"
    assert asked.say(NUT) == (("dX", probability(SURE)),)
    assert asked.fits == ["dX"], "which is enough"
    dull = replace(OTHER, evidence=1.0)
    assert asked.say(dull) == (("dX", probability(OTHER)), ("dY", probability(OTHER)))
    assert asked.say(dull) == asked.say(dull)
    assert asked.fits == ["dX", "dY"]


def test_an_axis_that_can_not_be_fitted_says_nothing(monkeypatch: pytest.MonkeyPatch, spec: Model) -> None:
    assert Asked(monkeypatch, spec, {"dY": [SURE]}).say(NUT) == (("dY", probability(SURE)),)


@pytest.mark.parametrize(
    ("changed", "goes"),
    [
        ({"fixed": {"tau": 60.0}}, True),
        ({"fixed": {"gain": 2.0}}, False),
        ({"acts_on": [Response(axis="Z")]}, False),
        ({"response": Response(axis="Z")}, False),
        ({"effect": "prediction", "file": "theirs.csv"}, False),
        ({"effect": "model", "name": "frame"}, False),
        ({"effect": "transfer_function", "fixed": {"numerator": 1.0}}, False),
    ],
)
def test_what_is_given_for_one_axis_says_nothing_of_another(
    monkeypatch: pytest.MonkeyPatch, spec: Model, changed: dict[str, Any], goes: bool
) -> None:
    own = EffectSpec(**{"effect": "spindle_bearing", **changed})
    asked = Asked(monkeypatch, spec.model_copy(update={"effects": [own]}), {"dX": [SURE], "dY": []})
    assert bool(asked.say(NUT)) == goes


def test_half_of_the_odds_there_are_added_to_the_odds_here() -> None:
    own = probability(NUT)
    assert 0.3 < own < CLAIMED
    assert blunt(NUT) is not None
    told = replace(NUT, also_on=(("dX", 0.6), ("dY", 0.95)))
    odds = own / (1 - own) * np.sqrt(0.95 / 0.05)
    assert probability(told) == pytest.approx(odds / (1 + odds))
    assert blunt(told) is None
    assert probability(replace(NUT, also_on=(("dX", 0.5),))) == own, "what may be or not says nothing"
    assert probability(replace(NUT, also_on=(("dX", 0.2),))) == own, "nor is it a reason against it"


def test_only_what_might_be_a_claim_with_them_is_asked_about() -> None:
    assert may_be_borne_out(NUT)
    assert not may_be_borne_out(replace(NUT, also_on=(("dX", 0.6),))), "it has been asked"
    assert not may_be_borne_out(scored(evidence=3900.0)), "it is a claim without them"
    at_limit = [scored(evidence=e) for e in np.geomspace(1, 390, 40)]
    assert {may_be_borne_out(s) for s in at_limit} == {True, False}
    assert all(may_be_borne_out(s) == (0.3 <= probability(s) < CLAIMED) for s in at_limit)
