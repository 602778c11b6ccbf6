"""Units that only values suggest: asked where they suit another one, on both sides of each limit."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from thermodata.calibration.channel import calibrate
from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import values_of
from thermodata.schema.files.campaign import Channel


def asked(name: str, *readings: float, unit: str | None = None) -> str:
    """The questions of a unit; readings: of a course that goes from the first to the last of them."""
    course = np.concatenate([np.linspace(a, b, 50) for a, b in pairwise(readings)])
    found = guess(name, unit, "float64", values_of(course))
    return "; ".join(q for q in found.questions if q.startswith("unit"))


@pytest.mark.parametrize(
    ("name", "readings", "question"),
    [
        ("Spindle speed", (0, 8, 0, 12), "unit: krpm, 1/s, or rpm? (values 0 to 12)"),
        ("Spindle speed", (0, 60), "unit: krpm, 1/s, or rpm? (values 0 to 60)"),
        ("Spindle speed", (0, 61), ""),
        ("Spindle speed", (0, 0), ""),
        ("table_speed", (0, 8), ""),
        ("T_bearing", (69.6, 104), "unit: degF, or degC? (values 69.6 to 104)"),
        ("T_bearing", (60, 104), "unit: degF, or degC? (values 60 to 104)"),
        ("T_bearing", (59.9, 104), ""),
        ("hall temperature", (45, 70), "unit: degF, or degC? (values 45 to 70)"),
        ("hall temperature", (44, 70), ""),
        ("OilTemp_F", (72, 90, 0, 90), "unit: degF, or degC? (values 0 to 90)"),
        ("OilTemp_F", (20, 90), ""),
        ("OilTemp_F", (0, 40, 90), ""),
    ],
)
def test_a_unit_that_values_suggest_is_asked_where_they_suit_another(
    name: str, readings: tuple[float, ...], question: str
) -> None:
    assert asked(name, *readings) == question


def test_a_unit_that_is_stated_is_not_asked() -> None:
    assert asked("Spindle speed", 0, 8, unit="rpm") == ""
    assert asked("T_bearing", 70, 104, unit="°C") == ""
    assert asked("Spindle speed_krpm", 0, 8) == ""


@pytest.mark.parametrize(
    ("name", "unit", "low", "high", "asked"),
    [
        ("dZ", "mm", 0.0, 19.0, "unit: mm? it goes over 19 mm"),
        ("dZ", "mm", 0.0, 0.3, ""),
        ("dZ", "um", 2000.0, 2300.0, ""),  # an offset of the probe is none
        ("Bett", "°C", 70.0, 87.0, "unit: °C? no reading is below 70 degC"),
        ("Bett", "°F", 70.0, 87.0, ""),
        ("T_front", "°C", 210.0, 346.0, "unit: °C? no reading is below 210 degC"),
        ("T_front", "°C", 21.0, 146.0, ""),
        ("T_oven", "°C", 210.0, 240.0, ""),
        ("P", "kW", 90.0, 3200.0, "unit: kW, or W? it goes up to 3.2e+03 kW"),
        ("P", "kW", 0.1, 480.0, ""),
        ("P", "W", 90.0, 3200.0, ""),
        ("n", "1/s", 0.0, 8000.0, "unit: 1/s, or rpm? it goes up to 4.8e+05 rpm"),
        ("n", "rpm", 0.0, 60000.0, ""),
        ("feed_X", "m/min", 0.0, 6000.0, "unit: m/min, or mm/min? it goes up to 6e+03 m/min"),
        ("feed_X", "mm/min", 0.0, 60000.0, ""),
        ("X pos", "in", 100.0, 900.0, "unit: in, or mm? it goes up to 22.9 m"),
        ("X pos", "in", -198.0, 0.0, "unit: in, or mm? it goes up to 5.03 m"),
        ("X pos", "in", -196.0, 0.0, ""),
        ("X pos", "ft", 0.0, 17.0, "unit: ft, or mm? it goes up to 5.18 m"),
        ("X pos", "ft", 0.0, 16.0, ""),
        ("X pos", "Zoll", 100.0, 900.0, "unit: Zoll, or mm? it goes up to 22.9 m"),
        ("X pos", "mm", 100.0, 9000.0, ""),
        ("Bett", "°C", 21.0, 87.0, ""),
        ("T Motor Z", "°C", 70.0, 87.0, ""),
        ("T_hall", "°C", 294.0, 310.0, "unit: K, or °C? no reading is below 294 degC"),
        ("T bearing front", "°C", 294.0, 320.0, "unit: K, or °C? no reading is below 294 degC"),
        ("T_hall", "K", 294.0, 310.0, ""),
        ("T tool", "°C", 21.0, 320.0, ""),  # of a cut
        ("T bearing front", "°C", 230.0, 320.0, "unit: °C? no reading is below 230 degC"),
        ("T_hall", "°C", 200.0, 210.0, "unit: °C? no reading is below 200 degC"),
        ("T bearing front", "°C", 4000.0, 4095.0, "raw counts, or K?"),
    ],
)
def test_a_unit_of_the_file_that_no_machine_suits_is_asked(
    name: str, unit: str, low: float, high: float, asked: str
) -> None:
    said = guess(name, unit, "float64", values_of(np.linspace(low, high, 200))).comment()
    assert asked in said if asked else "unit:" not in said


@pytest.mark.parametrize(
    ("name", "unit", "low", "high", "asked"),
    [
        ("spindle_load_ratio", None, 20.0, 41.0, 'unit: pu, or "%"? it goes up to 41'),
        ("Spindle Load (p.u.)", None, 0.0, 80.0, 'unit: p.u., or "%"? it goes up to 80'),
        ("Load fraction", None, 0.0, 100.0, 'unit: pu, or "%"? it goes up to 100'),
        ("rel_humidity_frac", None, 30.0, 60.0, 'unit: pu, or "%"? it goes up to 60'),
        ("humidity.pu", None, 30.0, 60.0, 'unit: pu, or "%"? it goes up to 60'),
        ("Spindle Load", "pu", -80.0, 10.0, 'unit: pu, or "%"? it goes up to 80'),
        ("spindle_load_ratio", None, 0.0, 2.51, 'unit: pu, or "%"? it goes up to 2.51'),
        ("spindle_load_ratio", None, 0.0, 2.5, ""),
        ("humidity.pu", None, 0.3, 0.6, ""),
        ("Spindle Load", "%", 0.0, 80.0, ""),
    ],
)
def test_a_share_of_one_that_goes_far_beyond_it_is_asked(
    name: str, unit: str | None, low: float, high: float, asked: str
) -> None:
    said = guess(name, unit, "float64", values_of(np.linspace(low, high, 200)))
    assert [q for q in said.questions if q.startswith("unit")] == ([asked] if asked else [])
    assert not (asked and said.sure)


@pytest.mark.parametrize("name", ["T_furnace", "Ofentemperatur", "Abgas 1", "exhaust/T3", "kiln", "T hot gas"])
@pytest.mark.parametrize(("low", "high"), [(600.0, 1200.0), (330.0, 390.0), (20.0, 900.0), (400.0, 700.0)])
def test_what_burns_may_be_hot(name: str, low: float, high: float) -> None:
    said = guess(name, "°C", "float64", values_of(np.linspace(low, high, 200)))
    assert said.quantity == "temperature"
    assert not [q for q in said.questions if "raw counts" in q or q.startswith("unit")]


@pytest.mark.parametrize(
    ("name", "unit", "low", "high", "asked"),
    [
        ("T_furnace", "°C", 2000.0, 4000.0, "raw counts, or K?"),
        ("T_furnace", "°C", 293.0, 390.0, "unit: K, or °C?"),  # before it was lit
        ("T_furnace", None, 600.0, 1200.0, "unit? (values 600 to 1200)"),
        ("T_furnace", None, 300.0, 400.0, "unit? (values 300 to 400)"),  # kelvins of others
        ("Hofende T", "°C", 600.0, 1200.0, "raw counts, or K?"),
        ("T bearing front", "°C", 330.0, 390.0, "unit: K, or °C?"),
    ],
)
def test_what_burns_is_asked_where_it_may_be_something_else(
    name: str, unit: str | None, low: float, high: float, asked: str
) -> None:
    said = guess(name, unit, "float64", values_of(np.linspace(low, high, 200)))
    assert asked in " ".join(said.questions)


BED = Channel(source="s", signal="x", quantity="temperature")
MEASURED = [f"{20 + k / 97:.3f}" for k in range(200)]


@pytest.mark.parametrize(
    ("cells", "said"),
    [
        (MEASURED, "changing slowly: a temperature in degC?"),
        ([c[:-1].replace(".", ",") for c in MEASURED], "changing slowly: a temperature in degC?"),
        ([f"{100 * float(c):.1f}" for c in MEASURED], "quantity and unit? numbers kept as text (2000 to 2205)"),
        ([c.replace(".", ",") for c in MEASURED], "numbers kept as text (20 to 22.05)"),
        (
            [c.translate(str.maketrans("0123456789.", "０１２３４５６７８９．")) for c in MEASURED],
            "numbers kept as text",
        ),
        ([*MEASURED, "", "n/a"], "changing slowly"),
        ([f"{1000 + k}" for k in range(200)], "sure: text"),  # of programs
        (["1.5", "2.5"] * 100, "sure: text"),  # versions of one
        ([f"N{c}" for c in MEASURED], "sure: text"),
    ],
)
def test_numbers_that_a_file_keeps_as_text_are_asked(cells: list[str], said: str) -> None:
    seen = values_of(np.array(cells, object))
    assert said in guess("bed", None, "str", seen).comment()


def test_texts_that_ingest_reads_as_numbers_are_drafted_by_what_their_name_says() -> None:
    seen = values_of(np.array(MEASURED, object))
    found = guess("/diagnostics.status.spindle.values.Temperature front [C].value", None, "str", seen)
    assert (found.quantity, found.unit, found.sure) == ("temperature", "degC", False)
    values, flags = calibrate(np.array(MEASURED, object), channel=BED, signal_unit="degC", scaling=None)
    assert values.tolist() == [float(c) for c in MEASURED]
    assert not flags.any()


def test_a_unit_in_the_letters_of_another_encoding_is_asked_for_that_first() -> None:
    seen = values_of(np.linspace(20.0, 30.0, 200))
    assert (
        "unit: encoding: cp850 in the source, by which 'řC' is '°C'" in guess("T [řC]", "řC", "float64", seen).comment()
    )
    assert "encoding" not in guess("T [tenths]", "tenths", "float64", seen).comment()


@pytest.mark.parametrize(
    ("name", "unit", "right"),
    [
        ("Capteur X [Âµm]", None, "µm"),
        ("Capteur X", "Âµm", "µm"),
        ("Capteur X [Î¼m]", "Î¼m", "μm"),
        ("BÃ¢ti [Â°C]", "Â°C", "°C"),
    ],
)
def test_a_unit_in_utf_8_that_was_read_as_windows_is_proposed_and_asked(
    name: str, unit: str | None, right: str
) -> None:
    found = guess(name, unit)
    assert (found.unit, found.sure) == (right, False)
    assert f"unit: {right}? the file says '" in found.comment()
    assert found.at == ("bed" if right == "°C" else "tcp")


@pytest.mark.parametrize("name", ["/thermo/spindle.variance", "T_stddev", "Varianz T1"])
def test_how_far_readings_scatter_is_no_reading(name: str) -> None:
    assert guess(name, None, "float64", values_of(np.linspace(0.0, 0.01, 200))).quantity is None


@pytest.mark.parametrize(
    "name", ["/rtd.layout.dim.size", "/rtd.layout.dim.rear,motor.stride", "/rtd.layout.data_offset"]
)
def test_how_an_array_is_laid_out_is_no_reading(name: str) -> None:
    found = guess(name, None, "float64", values_of(np.full(200, 2.0)))
    assert found.quantity is None
    assert "how an array is laid out" in found.comment()
    assert guess("/rtd.data[0]", None, "float64", values_of(np.linspace(20, 25, 200))).quantity == "temperature"
