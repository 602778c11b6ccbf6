"""Units written out, as LabVIEW and others do, in English or German."""

from __future__ import annotations

import pytest

from thermodata.reader.text.names.header import looks_like_unit, split_unit
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.unit import is_unit


@pytest.mark.parametrize(
    ("written", "unit", "factor"),
    [
        ("Micrometers", "um", 1.0),
        ("Micrometer", "um", 1.0),
        ("micrometre", "um", 1.0),
        ("Micrometres", "um", 1.0),
        ("Mikrometern", "um", 1.0),
        ("MILLIMETERS", "um", 1000.0),
        ("Nanometer", "um", 1e-3),
        ("Zentimeter", "mm", 10.0),
        ("Millivolts", "V", 1e-3),
        ("Milliampere", "A", 1e-3),
        ("Kilowatt", "kW", 1.0),
        ("Kilopascals", "bar", 0.01),
        ("Amperes", "A", 1.0),
        ("Prozent", "%", 1.0),
        ("Inches", "mm", 25.4),
    ],
)
def test_a_unit_written_out_is_known(written: str, unit: str, factor: float) -> None:
    assert linear_conversion(written, unit) == (pytest.approx(factor), 0.0)
    assert looks_like_unit(written)
    assert split_unit(f"dZ [{written}]") == ("dZ", written)


@pytest.mark.parametrize(
    "word", ["Micrometry", "Millimeterpapier", "Micro", "Kilo", "Milling", "Megabar", "Meter", "Bar"]
)
def test_words_that_are_none_stay_words(word: str) -> None:
    assert not looks_like_unit(word)
    assert not is_unit(word)


@pytest.mark.parametrize(
    ("written", "unit", "factor"),
    [
        ("mVolts", "V", 1e-3),
        ("mVolt", "V", 1e-3),
        ("MOhms", "Ohm", 1e6),
        ("kVolts", "V", 1e3),
        ("uVolts", "V", 1e-6),
        ("µVolts", "V", 1e-6),
        ("mVDC", "V", 1e-3),
        ("mAmps", "A", 1e-3),
        ("mADC", "A", 1e-3),
        ("kWatt", "kW", 1.0),
        ("kOhms", "Ohm", 1e3),
    ],
)
def test_the_letter_of_a_prefix_before_a_word_counts_in_its_case(written: str, unit: str, factor: float) -> None:
    assert linear_conversion(written, unit) == (pytest.approx(factor), 0.0)
    assert looks_like_unit(written)


@pytest.mark.parametrize("written", ["Degree F", "Degrees F", "degree f"])
def test_a_degree_of_fahrenheit_written_out_is_one(written: str) -> None:
    assert linear_conversion(written, "degC") == (pytest.approx(5 / 9), pytest.approx(-160 / 9))
