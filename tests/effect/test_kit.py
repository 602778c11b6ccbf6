"""Every installed effect passes the kit; every rule of the kit catches the effect that breaks it."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np
import pytest

from thermodata.effect import all_effects
from thermodata.effect.places import can_bind, in_vocabulary
from thermodata.errors import PluginError
from thermodata.plugin import Drivers, Float2D, Gain, Need, Param
from thermodata.testing import effect as kit


@pytest.mark.parametrize("name", sorted(all_effects()))
def test_the_installed_effect_keeps_the_contract(name: str) -> None:
    assert kit.faults(all_effects()[name]) == {}


class Good:
    name = "good"
    family = "test"
    meaning = "k u a"
    source = "made up"
    needs: tuple[Need, ...] = (Need("u", "temperature"),)
    params: tuple[Param, ...] = (Param("a", "1", 1.0, 0.5, 2.0, "a factor"),)
    gains: tuple[Gain, ...] = (Gain("gain", "um/K", (0, 10), "any", "k"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return (drivers.values["u"] * p["a"]).reshape(-1, 1)


class NoGain(Good):
    gains = ()

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return np.zeros((len(drivers.t_s), 0))


class EquationOfNoText(Good):
    equation = ("d", "=", "k u")


class TellsNothing(Good):
    telltale = " "


class RefinesByText(Good):
    refines = "good"


class ToldByNothing(Good):
    refines = ("good",)
    told_by = "place"


class TwiceTheName(Good):
    gains = (Gain("a", "um/K", (0, 10), "any", "k"),)


class NoSuchQuantity(Good):
    needs = (Need("u", "warmth"),)


class Nowhere(Good):
    needs = (Need("u", "temperature", ("bed", "bedd..x")),)


class PlacesOfOneText(Good):
    needs = (Need("u", "temperature", "axis.{a}.nut"),)  # type: ignore[arg-type]


class StartsOutside(Good):
    params = (Param("a", "1", 3.0, 0.5, 2.0, "a factor"),)


class ReachesLess(Good):
    params = (Param("a", "1", 1.0, 0.5, 2.0, "a factor", reach=(1.0, 3.0)),)


class Flat(Good):
    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return drivers.values["u"] * p["a"]


class Blows(Good):
    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        with np.errstate(divide="ignore", invalid="ignore"):
            return super().basis(drivers, p) / np.float64(2.0 - p["a"])


class NeverRests(Good):
    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return super().basis(drivers, p) + 1.0


class Deaf(Good):
    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return np.zeros((len(drivers.t_s), 1))


class Prophet(Good):
    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return super().basis(drivers, p)[::-1].copy()


class Forgetful(Good):
    calls = 0

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        type(self).calls += 1
        return super().basis(drivers, p) * type(self).calls


class Meddler(Good):
    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        out = super().basis(drivers, p)
        drivers.values["u"][:] += 1.0
        return out


class Idle(Good):
    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return drivers.values["u"].reshape(-1, 1).copy()


class CountsSamples(Good):
    """A lag of thirty samples, however long they last."""

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        x, out = 0.0, []
        for u in drivers.values["u"]:
            x += (u - x) / (30.0 * p["a"])
            out.append(x)
        return np.array(out).reshape(-1, 1)


class StopsInGaps(Good):
    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return np.where(drivers.valid["u"], drivers.values["u"] * p["a"], 0.0).reshape(-1, 1)


class NotLinearInKelvin(Good):
    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return (np.abs(drivers.values["u"]) ** (1.0 + p["a"])).reshape(-1, 1)


class Quadratic(Good):
    gains = (Gain("gain", "um/K2", (0, 10), "any", "k"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return (drivers.values["u"] ** 2 * p["a"]).reshape(-1, 1)


class QuadraticBesideAnother(Quadratic):
    needs = (Need("u", "temperature"), Need("around", "temperature", optional=True))
    gains = (Gain("gain", "um/K", (0, 10), "any", "k"), Gain("g2", "um/K^2", (0, 10), "any", "k of the square"))

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        u = drivers.values["u"] - drivers.values.get("around", 0.0 * drivers.t_s)
        return np.column_stack([u * p["a"], u**2])


class Above(Good):
    params = (Param("a", "K", 3.0, 1.0, 9.0, "from so much on it grows"),)

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        return np.maximum(drivers.values["u"] - p["a"], 0.0).reshape(-1, 1)


class LinearThatSaysSquare(Good):
    gains = (Gain("gain", "um/K2", (0, 10), "any", "k"),)


class KelvinForgotten(Good):
    gains = (Gain("gain", "um", (0, 10), "any", "k"),)


class KelvinOfMillimetres(Good):
    gains = (Gain("gain", "mm/K", (0, 10), "any", "k"),)


class OfNoPlace(Good):
    needs = (Need("u", "temperature", ("spindle.bearing.frnt",)),)


class Promises(Good):
    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[str, ...]:
        return ("lag(u, 60) * a",)


class LastDigit(Good):
    def bases(self, several: Sequence[Drivers], points: Sequence[Mapping[str, float]]) -> list[Float2D]:
        return [np.concatenate([self.basis(d, p) * (1 + 1e-15) for p in points], axis=1) for d in several]


class Lawful(Good):
    def law(self, roles: Collection[str], p: Mapping[str, float], step_s: float) -> tuple[str, ...]:
        return ("u * a",)


class Stated(Good):
    equation = "d = k u a"
    telltale = "goes with u"
    refines = ("good",)
    told_by = "u"


def test_a_good_effect_passes() -> None:
    kit.check_effect(Good())
    kit.check_effect(Stated())
    kit.check_effect(Lawful())


@pytest.mark.parametrize("sound", [Quadratic, QuadraticBesideAnother, Above])
def test_an_effect_need_not_be_linear_in_what_drives_it(sound: type[Good]) -> None:
    assert kit.faults(sound()) == {}


@pytest.mark.parametrize(
    ("broken", "rule"),
    [
        (NoGain, kit.it_has_all_that_the_contract_names),
        (EquationOfNoText, kit.what_it_states_beyond_the_contract_is_text),
        (TellsNothing, kit.what_it_states_beyond_the_contract_is_text),
        (RefinesByText, kit.what_it_states_beyond_the_contract_is_text),
        (ToldByNothing, kit.what_it_states_beyond_the_contract_is_text),
        (TwiceTheName, kit.its_names_are_unique),
        (NoSuchQuantity, kit.it_needs_quantities_that_exist),
        (Nowhere, kit.it_names_places_that_can_be),
        (PlacesOfOneText, kit.it_names_places_that_can_be),
        (StartsOutside, kit.its_bounds_hold_its_start),
        (ReachesLess, kit.its_bounds_hold_its_start),
        (Flat, kit.it_gives_one_column_a_gain),
        (Blows, kit.it_is_finite_at_every_bound),
        (NeverRests, kit.it_is_zero_at_rest),
        (Deaf, kit.it_answers_to_its_drivers),
        (Prophet, kit.it_does_not_look_ahead),
        (Forgetful, kit.it_says_the_same_twice),
        (Meddler, kit.it_says_the_same_twice),
        (Idle, kit.every_parameter_changes_something),
        (CountsSamples, kit.it_says_the_same_on_any_grid),
        (StopsInGaps, kit.a_gap_that_was_filled_right_changes_nothing),
        (NotLinearInKelvin, kit.its_gains_have_the_units_of_what_drives_them),
        (LinearThatSaysSquare, kit.its_gains_have_the_units_of_what_drives_them),
        (KelvinOfMillimetres, kit.its_units_are_those_of_the_library),
        (OfNoPlace, kit.it_names_places_of_the_vocabulary),
        (KelvinForgotten, kit.its_gains_have_the_units_of_what_drives_them),
        (Promises, kit.its_law_is_its_basis),
        (LastDigit, kit.its_bases_are_its_basis),
    ],
)
def test_each_rule_catches_its_broken_twin(broken: type[Good], rule: kit.Rule) -> None:
    assert rule.__name__ in kit.faults(broken())
    with pytest.raises(PluginError, match=rule.__name__):
        kit.check_effect(broken())


@pytest.mark.parametrize("place", ["bed", "Bed.Left-2", "axis.{a}.nut", "{s}spindle.bearing?", "hall.*", "table.d1500"])
def test_a_place_that_can_be_is_no_fault(place: str) -> None:
    assert can_bind(place)


@pytest.mark.parametrize("place", ["", ".", "bed.", "bedd..x", "axis.{a", "axis.{}.nut", "bed?.left", "bed left"])
def test_a_place_where_nothing_can_stand_is_told(place: str) -> None:
    assert not can_bind(place)


@pytest.mark.parametrize("unit", ["um/K", "um/K2", "um", "um/h", "um/K/min"])
def test_a_gain_is_in_um_by_what_drives_it(unit: str) -> None:
    assert not _units(gain=unit)


@pytest.mark.parametrize(
    "unit", ["mm/K", "um/rpm", "um/degC", "banana", "", "um/", "um/banana", "K", "um/s", "1", "um/u", "um/%"]
)
def test_a_gain_in_another_unit_is_told(unit: str) -> None:
    (why,) = _units(gain=unit)
    assert why == f"'gain' is in {unit!r}: it is um, or um by K, min, h"


@pytest.mark.parametrize("unit", ["min", "1", "%", "K", "m/min", "Hz", "1/K", "rpm"])
def test_a_parameter_is_in_a_unit_of_the_library(unit: str) -> None:
    assert not _units(param=unit)


@pytest.mark.parametrize("unit", ["s", "h", "banana", "", "mm/s", "degF"])
def test_a_parameter_in_another_unit_is_told(unit: str) -> None:
    (why,) = _units(param=unit)
    assert why.startswith(f"'a' is in {unit!r}: a time is in min, a number in 1, others in ")


def test_a_gain_is_by_the_metre_of_an_axis_and_by_the_unit_of_anything() -> None:
    of_an_axis = (Need("u", "temperature"), Need("x", "position"))
    assert not _units(gain="um/m/K", needs=of_an_axis)
    assert not _units(gain="um/u", needs=(Need("u", "*"),))
    assert _units(gain="um/m/K")


def _units(gain: str = "um/K", param: str = "1", needs: tuple[Need, ...] = Good.needs) -> list[str]:
    class One(Good):
        gains = (Gain("gain", gain, (0, 10), "any", "k"),)
        params = (Param("a", param, 3.0, 1.0, 9.0, "of it"),)

    One.needs = needs
    return list(kit.its_units_are_those_of_the_library(One()))


@pytest.mark.parametrize("place", ["bed", "axis.{a}.nut", "{s}spindle.bearing?", "hall.*", "table.d1500", "rotary.{a}"])
def test_a_place_of_the_vocabulary_is_no_fault(place: str) -> None:
    assert in_vocabulary(place)


@pytest.mark.parametrize("place", ["moon", "axis.{a}.nutt", "{s}spindel", "spindle.moon", "rotary.x"])
def test_a_place_that_no_campaign_has_is_told(place: str) -> None:
    assert not in_vocabulary(place)


def test_an_effect_that_wants_two_samples_is_told_that_it_was_asked_with_one() -> None:
    class Steps(Good):
        def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
            step = drivers.t_s[1] - drivers.t_s[0]
            return (drivers.values["u"] * p["a"] * step / step).reshape(-1, 1)

    said = kit.faults(Steps())[kit.it_gives_one_column_a_gain.__name__]
    assert said.startswith("asked with 1 sample, as a test may be, it raises IndexError: ")


def test_every_rule_has_a_broken_twin() -> None:
    marks = test_each_rule_catches_its_broken_twin.pytestmark  # type: ignore[attr-defined]
    assert {rule for _, rule in marks[0].args[1]} == set(kit.RULES)
