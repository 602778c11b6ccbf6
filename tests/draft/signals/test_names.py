"""The guesser on names that it was not written from: right, unsure, or wrong."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import values_of
from thermodata.draft.words.languages import LANGUAGES
from thermodata.draft.words.vocabulary import FOREIGN, PLACE_WORDS, QUANTITY_WORDS
from thermodata.reader.text.names.header import split_unit

NAMES = Path(__file__).with_name("names.txt")
LANGUAGE_NAMES = Path(__file__).with_name("names_of_languages.txt")


def verdict(line: str) -> str:
    """'right'; 'unsure' where it asks a person; 'wrong' where it is content with what is not so."""
    name, unit, quantity, places = line.split("|")
    found = guess(name, None if unit == "-" else unit)
    fitting = places.split(",")
    right = (found.quantity or "-") == quantity and (quantity == "-" or "*" in fitting or (found.at or "-") in fitting)
    return "right" if right else "unsure" if found.questions or found.quantity is None else "wrong"


def test_it_would_rather_ask_than_be_wrong() -> None:
    lines = [x for x in NAMES.read_text("utf-8").splitlines() if x and not x.startswith("#")]
    told = Counter(verdict(line) for line in lines)
    assert len(lines) > 200
    assert told["wrong"] <= 0.01 * len(lines), [x for x in lines if verdict(x) == "wrong"]
    assert told["right"] >= 0.90 * len(lines), told


def verdict_of_language(line: str) -> str:
    """As `verdict`, of a name with its unit, as a header has it; 'unplaced' where only the place is missing."""
    _, header, quantities, places = line.split("|")
    found = guess(*split_unit(header))
    fitting = places.split(",")
    if (found.quantity or "-") not in quantities.split(","):
        return "unsure" if found.questions or found.quantity is None or not found.sure else "wrong"
    if quantities == "-" or "-" in fitting or (found.at or "") in fitting:
        return "right"
    return "unsure" if found.questions or found.at is None or not found.sure else "wrong"


@pytest.mark.parametrize("language", ["es", "fr", "hu", "it", "ja", "ko", "pl", "pt", "ru", "sv", "tr", "zh"])
def test_names_of_other_languages_are_read_or_asked(language: str) -> None:
    lines = [x for x in LANGUAGE_NAMES.read_text("utf-8").splitlines() if x.startswith(f"{language}|")]
    told = Counter(verdict_of_language(line) for line in lines)
    assert len(lines) == 60
    assert told["wrong"] == 0, [x for x in lines if verdict_of_language(x) == "wrong"]
    assert told["right"] >= 48, told


@pytest.mark.parametrize("words", LANGUAGES)
def test_words_of_a_language_stand_by_the_keys_of_the_vocabulary(words: Mapping[str, str]) -> None:
    keys = {*QUANTITY_WORDS, *PLACE_WORDS, *(what for what, _ in FOREIGN), "setpoint", "limit", "difference"}
    assert set(words) <= keys


@pytest.mark.parametrize(
    ("name", "unit", "quantity"),
    [
        ("feed_x_m_min", "m/min", "feed"),
        ("feed_x_m_min", None, "feed"),
        ("coolant_flow_l_min", "l/min", "flow"),
        ("spindle_speed_1_min", "1/min", "rotational_speed"),
    ],
)
def test_the_minute_of_a_rate_is_no_smallest_value(name: str, unit: str | None, quantity: str) -> None:
    found = guess(name, unit)
    assert found.quantity == quantity
    assert "a limit, or a reading?" not in found.questions


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("feed_x_min", "m/min"),
        ("feed_x_max", "m/min"),
        ("flow min", "l/min"),
        ("T_bearing_min", "°C"),
        ("T_1_min", "°C"),
    ],
)
def test_a_smallest_value_is_asked(name: str, unit: str) -> None:
    assert "a limit, or a reading?" in guess(name, unit).questions


@pytest.mark.parametrize(
    "name",
    [
        "Probe bracket",
        "probe_bracket_degC",
        "/temperatures.probe_holder",
        "Sensorhalter",
        "Messtasterhalter",
        "Soporte sondas",
        "Support de palpeur",
        "Supporto sonda",
        "Suporte sonda",
    ],
)
def test_what_holds_the_probes_is_a_place(name: str) -> None:
    found = guess(name, "°C")
    assert (found.at, found.questions) == ("fixture", ())


def test_a_probe_alone_may_be_the_place_or_the_sensor() -> None:
    assert any("only the sensor?" in q for q in guess("Probe 3", "°C").questions)
    assert guess("Tool holder", "°C").at != "fixture"


@pytest.mark.parametrize(
    ("name", "at"),
    [
        ("chiller_out", "chiller.supply"),
        ("spindle chiller outlet", "chiller.supply"),
        ("冷水机出水温度", "chiller.supply"),
        ("チラー入口温度", "chiller.return"),
        ("Chiller Rücklauf", "chiller.return"),
        ("Chiller Vorlauf", "chiller.supply"),
    ],
)
def test_what_leaves_the_chiller_goes_to_the_machine(name: str, at: str) -> None:
    assert guess(name, "°C").at == at


@pytest.mark.parametrize("name", ["chladič výstup", "T_chladic_vstup", "Kühler Eintritt", "Temp. Rückkühler Austritt"])
def test_whether_a_cooler_is_the_chiller_or_what_is_cooled_is_asked(name: str) -> None:
    found = guess(name, "°C")
    assert found.at == "chiller"
    assert any("chiller.supply or .return?" in q for q in found.questions)


@pytest.mark.parametrize(
    ("name", "unit", "at"),
    [
        ("Enclosure air", "°C", "enclosure"),
        ("Machine interior temp", "°C", "enclosure"),
        ("Hall air", "°C", "hall"),
        ("防护门开", None, "enclosure"),
        ("Machine door open", None, "enclosure"),
        ("/plc/aux.hall_door", None, "hall.door"),
        ("roller door", None, "hall.door"),
    ],
)
def test_the_air_within_the_machine_is_not_the_hall(name: str, unit: str | None, at: str) -> None:
    assert guess(name, unit).at == at


@pytest.mark.parametrize(
    ("name", "unit", "at"),
    [
        ("S1_nAkt", "1/min", "spindle"),
        ("n_B", "1/min", "rotary.b"),
        ("n_C", "U/min", "table"),
        ("n_S", "1/min", "spindle"),
        ("Hallenboden", "°C", "floor"),
        ("Halle", "°C", "hall"),
        ("Hallentor_offen", None, "hall.door"),
        ("S1_Leistung", "kW", "spindle"),
        ("S2_Auslast", "%", "spindle"),
        ("S1_TempMotor", "°C", "spindle.motor"),
        ("S1_Temp", "°C", None),  # a sensor may be counted so
        ("S12", "°C", None),
        ("B_nIst", "1/min", "rotary.b"),
        ("A1_Drehzahl", "1/min", "rotary.a"),
        ("C_nAct", "1/min", "table"),
        ("nIst", "1/min", "spindle"),
    ],
)
def test_spindles_and_rotary_axes_are_told_by_their_letter(name: str, unit: str, at: str | None) -> None:
    """A speed of B is no spindle's."""
    assert guess(name, unit).at == at


@pytest.mark.parametrize(
    ("name", "quantity", "unit"),
    [
        ("/thermo.speed", "rotational_speed", None),
        ("/thermo.probes_um[0]", "displacement", "um"),
        ("/thermo.t_bearing", "temperature", "degC"),
        ("/cnc.axis.z.temp", "temperature", "degC"),
    ],
)
def test_the_field_of_a_message_says_what_it_is_not_its_topic(name: str, quantity: str, unit: str | None) -> None:
    found = guess(name, None)
    assert found.quantity == quantity
    assert unit is None or found.unit == unit


@pytest.mark.parametrize(
    ("name", "at"),
    [
        ("Arbeitsraum Luft", "enclosure"),
        ("WS.AirTemp", "enclosure"),
        ("Air enceinte", "enclosure"),
        ("Aria zona lavoro", "enclosure"),
        ("Workspace air", "enclosure"),
        ("Raumluft", "hall"),
        ("ENV.AirMid", "hall"),
        ("TAB.BrgTemp", "table.bearing"),
        ("Lager Rundtisch", "table.bearing"),
        ("Tisch Lager", "table.bearing"),
        ("Cuscinetto tavola", "table.bearing"),
        ("Palier plateau", "table.bearing"),
        ("Table bearing", "table.bearing"),
        ("Cuscinetto ant. mandrino", "spindle.bearing.front"),
        ("Palier arrière broche", "spindle.bearing.rear"),
        ("Montante sx", "column.left"),
        ("Montante dx", "column.right"),
        ("Montant gauche", "column.left"),
        ("Montant droit", "column.right"),
        ("Hall haut", "hall.top"),
        ("Hall bas", "hall.bottom"),
        ("Hall air", "hall"),
        ("Palier vis X", "axis.x.bearing"),
    ],
)
def test_places_of_italian_and_french_labs_and_the_air_of_the_working_space(name: str, at: str) -> None:
    """The air in which the part is cut is not the hall's, and a bearing beside a table is not the spindle's."""
    assert guess(name, "°C").at == at


@pytest.mark.parametrize(
    ("name", "quantity", "at"),
    [
        ("/hmc/temps.sp_motor", "temperature", "spindle.motor"),
        ("temps_nut_y", "temperature", "axis.y.nut"),
        ("Temps broche", "temperature", "spindle"),
        ("temps", None, None),
        ("Temps écoulé", None, None),
    ],
)
def test_temps_are_temperatures_but_for_the_french_column_of_times(
    name: str, quantity: str | None, at: str | None
) -> None:
    found = guess(name, None)
    assert (found.quantity, found.at) == (quantity, at)


@pytest.mark.parametrize(
    ("name", "asked"), [("Door", True), ("aux.door", True), ("hall_door", False), ("Tor", False), ("Schutztür", False)]
)
def test_whose_door_it_is_is_asked_where_the_name_leaves_it_open(name: str, asked: bool) -> None:
    assert any("hall.door, or enclosure" in q for q in guess(name, None, dtype="bool").questions) is asked


@pytest.mark.parametrize(
    ("name", "at", "asked"),
    [
        ("Air floor", "hall.bottom", True),
        ("Luft Boden", "hall.bottom", True),
        ("Hallenboden", "floor", False),
        ("Floor", "floor", False),
        ("Luft unten", "hall.bottom", False),
    ],
)
def test_air_at_the_floor_is_no_floor(name: str, at: str, asked: bool) -> None:
    found = guess(name, "°C")
    assert (found.at, any("near the floor" in q for q in found.questions)) == (at, asked)


def test_a_tank_is_one_with_and_without_its_umlaut() -> None:
    assert {guess(name, "°C").at for name in ("KSS Behälter", "KSS Behaelter")} == {"coolant.tank"}


@pytest.mark.parametrize(
    ("name", "at"),
    [
        ("Ram front", "ram.front"),
        ("Z-Schieber hinten", "ram.rear"),
        ("滑枕前侧温度", "ram.front"),
        ("Crossbeam top", "crossbeam.top"),
        ("Querbalken unten", "crossbeam.bottom"),
        ("Traversa sotto", "crossbeam.bottom"),
        ("Ram", "ram"),
        ("Ram front bearing", "spindle.bearing.front"),
        ("Bed top", "bed.top"),
        ("Maschinenbett unten", "bed.bottom"),
        ("床身上部温度", "bed.top"),
        ("Bett", "bed"),
    ],
)
def test_the_side_of_a_beam_is_read(name: str, at: str) -> None:
    found = guess(name, "°C")
    assert (found.at, found.questions) == (at, ())


@pytest.mark.parametrize(
    "name",
    ["Messuhr X", "Dial gauge X", "Comparatore X", "Reloj comparador X", "Induktivtaster X", "千分表X", "úchylkoměr X"],
)
def test_a_dial_gauge_measures_a_displacement(name: str) -> None:
    found = guess(name, "mm")
    assert (found.quantity, found.axis) == ("displacement", "X")


@pytest.mark.parametrize(
    ("name", "at"),
    [
        ("Hall high [C]", "hall.top"),
        ("Hall air high", "hall.top"),
        ("Halle hoch", "hall.top"),
        ("Raumluft oben", "hall.top"),
        ("Hala nahoře", "hall.top"),
        ("Hala vysoko", "hall.top"),
        ("Ambiente alto", "hall.top"),
        ("Aria sopra", "hall.top"),
        ("Hall air low", "hall.bottom"),
        ("Halle tief", "hall.bottom"),
        ("Hala nízko", "hall.bottom"),
        ("Column high", "column.top"),
        ("Halle 1,5 m hoch", "hall"),  # how high, and that at the machine
        ("Hall high speed door", "hall.door"),
        ("Coolant high pressure", "coolant"),
    ],
)
def test_high_and_low_are_ends_of_a_gradient(name: str, at: str) -> None:
    assert guess(name, "°C").at == at


@pytest.mark.parametrize(
    ("name", "at"), [("Temp Vorlauf Spindelkühler", "chiller"), ("摆头冷却机出水温度", "chiller"), ("Luft 8 m", "hall")]
)
def test_a_cooler_is_none_of_what_it_cools_and_a_height_is_asked(name: str, at: str) -> None:
    found = guess(name, "°C")
    assert (found.at or "").partition(".")[0] == at
    assert any("hall.top" in q for q in found.questions) == (at == "hall")


@pytest.mark.parametrize(
    ("name", "unit"),
    [("Velocità asse A", "1/min"), ("Vitesse axe A", "tr/min"), ("Torquemotor A", "°C"), ("A軸回転速度", "rpm")],
)
def test_a_rotary_axis_is_read_in_further_languages(name: str, unit: str) -> None:
    assert (guess(name, unit).at or "").startswith("rotary.a")


@pytest.mark.parametrize(
    ("name", "unit", "at"),
    [
        ("Motortemp S3 Gegenspindel", "°C", "counter_spindle.motor"),
        ("Drehzahl Gegenspindel", "1/min", "counter_spindle"),
        ("counter_spindle_load", "%", "counter_spindle"),
        ("counter_spindle_motor_temp", "degC", "counter_spindle.motor"),
        ("Subspindle load", "%", "counter_spindle"),
        ("副主轴前轴承温度", "℃", "counter_spindle.bearing.front"),
        ("Main spindle front bearing", "°C", "spindle.bearing.front"),
        ("Frässpindel Lager vorn", "°C", "spindle.bearing.front"),  # of a milling machine
        ("Turret housing", "°C", "turret"),
        ("Live tool speed", "rpm", "turret"),
        ("Werkzeugrevolver Motor", "°C", "turret.motor"),
    ],
)
def test_spindles_and_turrets_of_a_turn_mill_centre_are_told_apart(name: str, unit: str, at: str) -> None:
    found = guess(name, unit)
    assert (found.at, found.sure, found.questions) == (at, True, ())


def test_an_amplifier_is_no_axis() -> None:
    assert guess("MX840B_0_CH 24", "°C").at is None
    assert guess("Motor X 2", "°C").at == "axis.x.motor"


@pytest.mark.parametrize(
    ("name", "unit", "at", "axis"),
    [
        ("MX1609_CH1 Lager A", "°C", None, None),
        ("MX840_CH2 Weg Z", "µm", "tcp", "Z"),
        ("MX840_CH3 Taster Y", "µm", "tcp", "Y"),
        ("MX840B_0_CH 5 Weg X", "µm", "tcp", "X"),
        ("Rack/DX100 CH02: Wirbelstrom Z", "V", "tcp", "Z"),
        ("MX1609_CH7", "°C", None, None),
        ("Lager01_CH2", "°C", "spindle.bearing", None),
        ("Motor X_CH2", "°C", "axis.x.motor", None),
    ],
)
def test_the_axis_is_in_the_words_behind_an_amplifier(name: str, unit: str, at: str | None, axis: str | None) -> None:
    found = guess(name, unit)
    assert (found.at, found.axis) == (at, axis)


def test_a_designation_that_names_a_sensor_stays() -> None:
    assert guess("Pt100_CH2", None).quantity == "temperature"
    assert guess("GL840_CH2", None).quantity is None


def test_a_counter_is_a_number_and_a_counter_spindle_none() -> None:
    assert guess("part counter", None).why_not
    found = guess("counter_spindle_load", None)
    assert (found.quantity, found.at) == ("load", "counter_spindle")


@pytest.mark.parametrize(
    ("name", "quantity", "unit"),
    [
        ("spindle_speed_krpm", "rotational_speed", "krpm"),
        ("giri_mandrino_rps", "rotational_speed", "rps"),
        ("T_air_degF", "temperature", "degF"),
        ("spindle_load_permille", "load", "permille"),
        ("spindle_load_%", "load", "%"),
        ("feed_x_ipm", "feed", "ipm"),
        ("dX_inch", "displacement", "inch"),
    ],
)
def test_a_unit_at_the_end_of_a_name_is_its_own(name: str, quantity: str, unit: str) -> None:
    found = guess(name, None)
    assert (found.quantity, found.unit) == (quantity, unit)


def test_an_f_at_the_end_is_asked_where_the_values_may_be_fahrenheit() -> None:
    def asked(low: float, high: float) -> bool:
        values = values_of(np.linspace(low, high, 50))
        return any("degF" in q for q in guess("T_front_bearing_F", None, "float64", values).questions)

    assert asked(71.0, 89.0)
    assert not asked(21.0, 38.0), "of the front"


@pytest.mark.parametrize("name", ["__index_level_0__", "Unnamed: 0"])
def test_numbers_of_rows_are_no_level(name: str) -> None:
    found = guess(name, None, "int64", values_of(np.arange(300.0)))
    assert found.quantity is None
    assert "pandas" in found.comment()
