"""A row of units in which some are not known: known ones are used, the others stand as written and are asked for."""

from __future__ import annotations

import pytest

from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import values_of
from thermodata.plugin import Array
from thermodata.reader.text.names.header_rows import names_and_units


def _layout(names: str, units: str, *more: str) -> dict[str, str | None]:
    rows = [line.split(";") for line in (names, units, *more)]
    found, of, _ = names_and_units(rows, len(rows[0]), None)
    return dict(zip(found, of, strict=True))


def test_units_that_are_not_known_stand_among_known_ones() -> None:
    read = _layout("Time;d3Z;d4Z;d6Z;M1;T3;T bed;Q", "s;µin;tenths;10 nm;Ncm;°R;°X;L/min")
    assert list(read.values()) == ["s", "µin", "tenths", "10 nm", "Ncm", "°R", "°X", "L/min"]


def test_a_unit_of_time_below_the_word_for_it_makes_a_row_of_units() -> None:
    assert _layout("Time;a;b;c;d", "s;Zoll;tenths;ticks;mV") == {
        "Time": "s",
        "a": "Zoll",
        "b": "tenths",
        "c": "ticks",
        "d": "mV",
    }


@pytest.mark.parametrize("below", ["min;avg;max", "s;front;rear of the machine"])
def test_statistics_and_words_below_names_are_no_units(below: str) -> None:
    assert set(_layout("Time;T front;T rear", below).values()) <= {None, "s"}


def test_what_a_logger_writes_for_stamps_and_records_is_no_unit() -> None:
    read = _layout("TIMESTAMP;RECORD;T_bed;T_hall;U", "TS;RN;Deg C;Deg C;Volts", ";;Avg;Avg;Smp")
    assert read == {"TIMESTAMP": None, "RECORD": None, "T_bed": "Deg C", "T_hall": "Deg C", "U": "Volts"}


@pytest.mark.parametrize(
    ("names", "units", "found"),
    [
        ("Number;Date&Time;ms;CH5;Alarm1-10;AlarmOut", "NO.;Time;ms;V;A1234567890;A1234", "V"),
        ("Number;Date&Time;ms;CH5;Alarm1-10;Alarm11-20;AlarmOut", "NO.;Time;ms;mm;A1234567890;A1234567890;A1234", "mm"),
        ("TIMESTAMP;RECORD;CH5", "TS;RN;Deg C", "Deg C"),
    ],
)
def test_one_channel_beside_stamps_and_alarms_has_its_unit(names: str, units: str, found: str) -> None:
    read = _layout(names, units)
    assert list(read) == names.split(";")
    assert {name: unit for name, unit in read.items() if unit not in (None, "ms")} == {"CH5": found}


def test_names_of_one_letter_beside_a_time_are_no_units() -> None:
    assert list(_layout("Pos;;", "No.;Time;T")) == ["No.", "Time", "T"]


def test_a_channel_in_a_unit_that_is_not_known_is_no_temperature_by_its_values(creeping: Array) -> None:
    said = guess("d4Z", "tenths", "float64", values_of(creeping))
    assert said.quantity is None
    assert said.why_not == "quantity and unit? the file says 'tenths', which is no unit known here"
    named = guess("T_bed", "°X", "float64", values_of(creeping))
    assert (named.quantity, named.unit) == ("temperature", None)


def test_a_number_before_a_unit_in_brackets_is_asked(creeping: Array) -> None:
    said = guess("d6Z [10 nm]", None, "float64", values_of(creeping))
    assert said.quantity is None
    assert "the file says '10 nm': is each count one of these, or is that a range?" in (said.why_not or "")
    assert guess("T6 [2]", None, "float64", values_of(creeping)).quantity == "temperature"


@pytest.fixture
def creeping() -> Array:
    import numpy as np

    return np.linspace(13.0, 16.6, 360)


def test_units_stand_above_what_the_user_called_the_channels() -> None:
    read = _layout("DATUM:;ZEIT:;M00: °F;M01: V", ";;T Lager;P Motor Strom")
    assert read == {"DATUM:": None, "ZEIT:": None, "T Lager": "°F", "P Motor Strom": "V"}
    read = _layout("DATUM:;ZEIT:;M00: °C;M01: °F;M02: mm", ";;Lager;Lager;Weg")
    assert list(read.items())[2:] == [("M00/Lager", "°C"), ("M01/Lager", "°F"), ("M02/Weg", "mm")]


def test_names_that_repeat_are_told_apart_by_the_comments_below_their_units() -> None:
    columns, units = "A(X);B(Y);C(Y);D(yEr±)", "min;°C;mm;um"
    read = _layout(columns, "Time;Front bearing;TCP Z;TCP Z", units, ";Pt100;probe 1;error")
    assert read == {"Time": "min", "Front bearing": "°C", "TCP Z/probe 1": "mm", "TCP Z/error": "um"}
    read = _layout(columns, "Time;Front bearing;TCP Z;TCP X", units, ";Pt100;probe 1;error")
    assert read == {"Time": "min", "Front bearing": "°C", "TCP Z": "mm", "TCP X": "um"}


@pytest.mark.parametrize(
    ("heads", "units"),
    [
        ("Channel;Ch 1 (A);Ch 2 (A);Ch 3 (V)", [None, None, None]),
        ("Zeit;Lager vorn (A);Lager hinten (C);Gehäuse (K)", [None, None, None]),
        ("Sensor;PT100 (A);PT100 (B);Kraft (N)", [None, None, None]),
        ("Channel;Ch 1 [°C];Ch 2 (DEG F);Ch 3 [V]", ["°C", "DEG F", None]),
        ("DATUM:;M00: °C;M01: V;M02: mm", ["°C", "V", "mm"]),
    ],
)
def test_a_full_row_above_the_names_says_units_of_sensors_only_where_they_can_be_nothing_else(
    heads: str, units: list[str | None]
) -> None:
    assert list(_layout(heads, "Time;T_front;T_rear;T_case").values())[1:] == units
