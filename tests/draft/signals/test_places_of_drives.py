"""Places beside a drive: belts, the bearing that supports a screw, the housing of a second spindle."""

from __future__ import annotations

import pytest

from thermodata.draft.signals.guess import guess


@pytest.mark.parametrize("name", ["T belt drive", "T cinghia", "Riementemperatur", "Temp. courroie", "T_remen"])
def test_a_belt_stands_between_motor_and_spindle(name: str) -> None:
    found = guess(name, "degC")
    assert found.at == "spindle.gearbox"
    assert found.questions == ("at: spindle.gearbox, of the belt between motor and spindle?",)


@pytest.mark.parametrize(
    ("name", "at", "asked"),
    [
        ("T spindle belt", "spindle.gearbox", 0),
        ("T belt X", None, 1),
        ("T belt motor spindle", "spindle.motor", 0),
        ("T spindle drive", "spindle.drive", 0),
    ],
)
def test_a_belt_of_the_spindle_is_told_and_of_an_axis_asked(name: str, at: str | None, asked: int) -> None:
    found = guess(name, "degC")
    assert (found.at, len(found.questions)) == (at, asked)


@pytest.mark.parametrize(
    ("name", "at"),
    [
        ("T supporto vite X", "axis.x.bearing"),
        ("T supporto della vite Z", "axis.z.bearing"),
        ("Ballscrew support Y", "axis.y.bearing"),
        ("T vite X", "axis.x.screw"),
        ("T chiocciola X", "axis.x.nut"),
        ("T supporto sonda", "fixture"),
    ],
)
def test_what_supports_a_screw_is_its_bearing(name: str, at: str) -> None:
    assert guess(name, "degC").at == at


@pytest.mark.parametrize(
    ("name", "at", "sure"),
    [
        ("T contromandrino testa", "counter_spindle", False),
        ("Gegenspindel Spindelkasten", "counter_spindle", False),
        ("T testa", "headstock", True),
        ("T testa mandrino", "headstock", True),
    ],
)
def test_the_housing_of_the_second_spindle_is_not_that_of_the_first(name: str, at: str, sure: bool) -> None:
    found = guess(name, "degC")
    assert (found.at, found.sure) == (at, sure)


@pytest.mark.parametrize("topic", ["cn", "/cn", "nc", "commande"])
@pytest.mark.parametrize(
    ("name", "unit", "at"),
    [
        ("vitesse_broche", "rpm", "spindle"),
        ("puissance_broche_kw", "kW", "spindle"),
        ("T_moteur_Y", "degC", "axis.y.motor"),
    ],
)
def test_a_commande_numerique_is_no_c_axis(topic: str, name: str, unit: str, at: str) -> None:
    assert guess(f"{topic}.{name}", unit).at == at


@pytest.mark.parametrize("name", ["Cn", "C n", "C speed", "n_C", "C1_rpm", "Drehzahl C"])
def test_the_speed_of_a_c_axis_is_one(name: str) -> None:
    assert guess(name, "rpm").at in ("table", "rotary.c")
