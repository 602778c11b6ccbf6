"""What Dutch, Turkish, Portuguese and Polish labs call their places: drafted where the words tell, and asked where they
may mean two."""

from __future__ import annotations

import pytest

from thermodata.draft.courses.kinds import kind_of
from thermodata.draft.signals.guess import guess
from thermodata.reader.text import split_unit


@pytest.mark.parametrize(
    ("header", "quantity", "place"),
    [
        ("Temp. tafellager [°C]", "temperature", "table.bearing"),
        ("Temp. spillager voor [°C]", "temperature", "spindle.bearing.front"),
        ("Temp. moer Z [°C]", "temperature", "axis.z.nut"),
        ("hal_boven_degC", "temperature", "hall.top"),
        ("hal_onder_degC", "temperature", "hall.bottom"),
        ("dwarsbalk_boven_degC", "temperature", "crossbeam.top"),
        ("dwarsbalk_onder_degC", "temperature", "crossbeam.bottom"),
        ("werkstuk_degC", "temperature", "workpiece"),
        ("Koelmiddel aan [-]", "state", "coolant"),
        ("Voeding X [m/min]", "feed", "axis.x"),
        ("Toerental tafel [1/min]", "rotational_speed", "table"),
        ("Kesme yağı sıcaklığı (°C)", "temperature", "coolant"),
        ("Hidrolik yağ sıcaklığı (°C)", "temperature", "hydraulics"),
        ("Temp. óleo de corte [°C]", "temperature", "coolant"),
        ("Óleo de corte ligado", "state", "coolant"),
        ("Cutting oil [°C]", "temperature", "coolant"),
        ("T_ar [°C]", "temperature", "hall"),
        ("Temp. do ar [°C]", "temperature", "hall"),
        ("T_lozko [°C]", "temperature", "bed"),
        ("T_łoże_góra [°C]", "temperature", "bed.top"),
    ],
)
def test_a_place_that_is_told_is_not_asked(header: str, quantity: str, place: str) -> None:
    found = guess(*split_unit(header))
    assert (found.quantity, found.at, found.questions) == (quantity, place, ())


@pytest.mark.parametrize(
    ("header", "asked"),
    [
        ("T_oleo [°C]", "at: hydraulics, lubrication, or coolant"),
        ("Yağ sıcaklığı [°C]", "at: hydraulics, lubrication, or coolant"),
        ("Temp. lager [°C]", "spindle.bearing.front or .rear?"),
        ("Temp. moer [°C]", "which axis's nut?"),
        ("Frame [°C]", "at: bed, column or crossbeam, of the frame?"),
        ("Temp. Maschinengestell [°C]", "at: bed, column or crossbeam, of the frame?"),
        ("T_arm [°C]", "where on the machine?"),
        ("Schalttafel [°C]", "where on the machine?"),  # a switch board, in German
    ],
)
def test_a_place_that_words_leave_open_is_asked(header: str, asked: str) -> None:
    assert any(asked in q for q in guess(*split_unit(header)).questions)


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("kesme_2", "cutting"),
        ("kesme_yagi", "other"),  # what the oil does, without a cut
        ("oleo de corte", "other"),
        ("tafel_120", "rotary_axis"),
        ("tafel_Z", "linear_axis"),
        ("tabla_40", "rotary_axis"),
        ("voeding_Z", "linear_axis"),
        ("besleme_1", "linear_axis"),
        ("gemengd_1", "mixed"),
        ("karma_2", "mixed"),
        ("mieszany_3", "mixed"),
        ("fuso_8000", "spindle"),
        ("karman_2", "other"),
        ("schalttafel", "other"),
    ],
)
def test_a_kind_is_told_by_the_name_of_a_test(name: str, kind: str) -> None:
    assert kind_of(name, []).kind == kind
