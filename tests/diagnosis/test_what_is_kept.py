"""What rankings share: columns of candidates and of known effects, kept and the same as made anew."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from thermodata.diagnosis.candidates import basis as module
from thermodata.diagnosis.candidates.basis import Means, basis, sharing
from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.clocks.by_commands import timings
from thermodata.diagnosis.question.known_effects import remembered
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.steps.commanded import commands_of
from thermodata.modelling.fit.model import fit_model
from thermodata.plugin import Drivers, Float2D, Param
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import ChannelInfo

from .conftest import make_data
from .hand_made import Parts, PlainEffect, problem

TAU = Param("tau", "min", 30, 1, 360, "")
EXPONENT = Param("exponent", "1", 1.5, 1.0, 2.5, "")


@dataclass(frozen=True)
class Scaled(PlainEffect):
    """The driver over the time constant; an exponent changes nothing."""

    params: tuple[Param, ...] = (TAU, EXPONENT)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return (drivers.values["u"] / p["tau"])[:, None]


def task(count: int = 3) -> Problem:
    rng = np.random.default_rng(0)
    return problem(
        *(Parts(rng.normal(size=120), values={"T_a": np.cumsum(rng.normal(size=120))}) for _ in range(count))
    )


def test_a_point_that_changes_nothing_is_not_ranked_again() -> None:
    found = basis(task(), CandidateEffect(Scaled(), {"u": "T_a"}, "feed_x"))
    assert len(found.points) == 10, "the time constants of an effect that has no exponent"
    assert {p["exponent"] for p in found.points} == {1.5}, "where it starts"
    assert [o.shape for o in found.others] == [(120, 10, 2, 1)] * 3


@dataclass(frozen=True)
class Refused(Scaled):
    """It may not be asked where nothing moves."""

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        assert drivers.values["u"].any()
        return super().basis(drivers, p)


def test_what_rests_in_a_test_is_not_asked_there() -> None:
    rng = np.random.default_rng(0)
    of = [np.zeros(120), np.cumsum(rng.normal(size=120))]
    one = problem(*(Parts(rng.normal(size=120), values={"T_a": u}) for u in of))
    found = basis(one, CandidateEffect(Refused(), {"u": "T_a"}, "feed_x"))
    assert [bool(own.any()) for own in found.own] == [False, True]
    assert [own.shape for own in found.own] == [(120, 10, 1)] * 2


@dataclass(frozen=True)
class Powered(Scaled):
    """The driver, to the power of an exponent, over the time constant."""

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return (np.abs(drivers.values["u"]) ** p["exponent"] / p["tau"])[:, None]


@pytest.mark.parametrize(("resting", "points"), [(0, 20), (2, 20), (3, 1)])
def test_an_exponent_counts_where_it_changes_a_column_of_any_test(resting: int, points: int) -> None:
    courses = [np.zeros(120) if i < resting else 2.0 * np.cos(np.arange(120) / 9) for i in range(3)]
    asked = problem(*(Parts(np.sin(np.arange(120.0)), values={"T_a": c}) for c in courses))
    found = basis(asked, CandidateEffect(Powered(), {"u": "T_a"}, "feed_x"))
    assert len(found.points) == points, "all points of what never moves are one"
    assert not any(b.any() for b in found.own) or len({p["exponent"] for p in found.points}) == 4


def test_columns_are_kept_beside_a_second_effect_and_not_with_other_offsets() -> None:
    one, candidate = task(), CandidateEffect(Scaled(), {"u": "T_a"}, "feed_x")
    made = basis(one, candidate)
    assert basis(one, candidate) is made
    assert basis(replace(one, blocks=one.blocks), candidate) is made
    assert basis(one, CandidateEffect(Scaled(), {"u": "T_a"}, "feed_x")) is not made
    cut = one.split({("c", "t0"): [3000.0]})
    assert basis(cut, candidate) is not made


def test_what_is_beyond_a_quarter_of_a_gigabyte_is_made_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    assert module.KEPT_BYTES == 256 * 2**20
    one, candidate = task(), CandidateEffect(Scaled(), {"u": "T_a"}, "feed_x")
    monkeypatch.setattr(module, "KEPT_BYTES", basis(task(), candidate).nbytes - 1)
    assert basis(one, candidate) is not basis(one, candidate)


@dataclass(frozen=True)
class Counted(Scaled):
    """The same, and how often it was asked."""

    calls: list[float] = field(default_factory=list, compare=False)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        self.calls.append(p["tau"])
        return Scaled.basis(self, drivers, p)


def test_what_a_candidate_does_in_a_test_is_made_once_for_all_axes() -> None:
    effect, means = Counted(params=(TAU,)), Means()
    one = task()
    basis(sharing(one, means), CandidateEffect(effect, {"u": "T_a"}, "feed_x"))
    of_one = len(effect.calls)
    found = basis(sharing(replace(one, kept={}), means), CandidateEffect(effect, {"u": "T_a"}, "feed_x"))
    assert len(effect.calls) == of_one > 0
    np.testing.assert_array_equal(found.own, basis(one, CandidateEffect(Scaled(params=(TAU,)), {"u": "T_a"}, "")).own)

    cut = one.split({("c", "t0"): [3000.0]})
    offsets = basis(sharing(cut, means), CandidateEffect(effect, {"u": "T_a"}, "feed_x"))
    assert len(effect.calls) == of_one, "offsets go out of what is shared"
    assert not np.array_equal(offsets.own[0], found.own[0])

    gap = one.split({("c", "t0"): [3000.0]}, parted_s=100.0)
    basis(sharing(gap, means), CandidateEffect(effect, {"u": "T_a"}, "feed_x"))
    assert len(effect.calls) == of_one * 4 // 3, "a test of other samples has its own"
    basis(sharing(task(), means), CandidateEffect(effect, {"u": "T_a"}, "feed_x"))
    assert len(effect.calls) == of_one * 7 // 3, "and so have other tests"


def test_clocks_and_commands_are_asked_once_of_a_problem() -> None:
    one = task()
    channels = {"dZ": ChannelInfo("dZ", "displacement", "um")}
    assert timings(one, channels) is timings(one, channels)
    assert commands_of(one) is commands_of(one)
    assert commands_of(replace(one, kept={})) is not commands_of(one)


def test_a_changed_copy_of_a_test_has_its_own_columns_and_leaves_those_of_the_test_alone(spec: Model) -> None:
    two = spec.model_copy(
        update={"effects": [*spec.effects, EffectSpec(effect="ambient_frame", drivers={"temperature": "T_hall"})]}
    )
    data = make_data(lambda c, t: 2.0 * (c["T_hall"] - c["T_hall"][0]), tests=4)
    (response,) = fit_model(two, data, uncertainty=False).responses
    test = data.tests[0]
    moved = replace(test, values={**test.values, "T_hall": np.roll(test.values["T_hall"], 5)})
    base = remembered(response)
    for asked in (test, moved, test, data.tests[1], moved):
        np.testing.assert_array_equal(base(asked), remembered(response)(asked))
    assert not np.array_equal(base(test), base(moved))
    np.testing.assert_array_equal(base(test)[:, :2], base(moved)[:, :2])
