"""Names in any script: words, channel names, and guesses that never fail."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from thermodata.draft.campaign.channels.wished_names import wished_name
from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.units import quantities_of
from thermodata.draft.signals.values import joined, values_of
from thermodata.draft.words.naming import channel_name, plain, words
from thermodata.reader.text.names.unit_in_name import unit_at_end
from thermodata.schema.files.campaign import NAME, RESERVED_NAMES

EASY = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
UNITS = st.sampled_from(
    [None, "degC", "V", "um", "mm", "K", "%", "Hz", "um/m", "1/min", "g", "-", "", "nonsense", "Grd C"]
)


@EASY
@given(st.lists(st.text(max_size=30), max_size=12))
def test_channel_names_are_legal_and_unique_for_any_names(names: list[str]) -> None:
    taken: set[str] = set()
    made = []
    for name in names:
        made.append(channel_name(name, taken))
        taken.add(made[-1].lower())
    assert all(NAME.match(m) and "__" not in m and m.lower() not in RESERVED_NAMES for m in made)
    assert len({m.lower() for m in made}) == len(names)


@EASY
@given(st.text(max_size=40), UNITS, st.sampled_from(["float64", "int32", "bool", "str"]))
def test_any_name_gets_an_answer(name: str, unit: str | None, dtype: str) -> None:
    found = guess(name, unit, dtype)
    assert found.comment()
    assert found.quantity is not None or found.why_not
    assert not (found.sure and found.questions)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("Eddy/nActSpeed_Z1", "eddy n act speed z 1"),
        ("ŽluťoučkýKůň-Straße", "zlutoucky kun strasse"),
        ("主轴T1温度", "主轴 t 1 温度"),
        ("Xload", "x load"),
        ("S1rpm", "spindle 1 rpm"),
        ("TEMP1", "temp 1"),
    ],
)
def test_words_come_apart(name: str, expected: str) -> None:
    assert words(name) == expected


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("前轴承温度", "qian_zhou_cheng_wen_du"),
        ("Температура шпинделя", "Temperatura_shpindelya"),
        ("θ_1", "theta_1"),
        ("ΔT", "delta_T"),
        ("Öl µm", "Ol_um"),
        ("龘", "da"),
        ("\U00030000", "u30000"),
    ],
)
def test_any_script_becomes_plain_letters(name: str, expected: str) -> None:
    assert plain(name) == expected


def test_a_syllable_of_hangul_stays_whole() -> None:
    assert plain("주축") == "ju_chug"


def test_units_in_names_and_units_that_say_nothing() -> None:
    assert (unit_at_end("x_mm"), unit_at_end("level.mm"), unit_at_end("F_mm_min"), unit_at_end("Motor")) == (
        "mm",
        "mm",
        "mm/min",
        None,
    )
    assert quantities_of("Hz") == ()  # a frequency is no speed
    assert quantities_of("um/m") == ()  # a strain is no tilt
    assert quantities_of("g") == ()


@pytest.mark.parametrize(
    ("name", "unit", "expected"),
    [
        ("level.mm", None, None),
        ("grid frequency", "Hz", None),
        ("strain 1", "um/m", None),
        ("ch7", "V", "voltage"),
        ("weight", "g", None),
        ("share", "%", None),
        ("T_bearing", "mA", "current"),
        ("Feed Override", "%", None),
    ],
)
def test_nothing_is_made_up(name: str, unit: str | None, expected: str | None) -> None:
    found = guess(name, unit)
    assert found.quantity == expected
    assert found.questions or found.why_not


def test_values_decide_where_neither_name_nor_unit_does() -> None:
    rng = np.random.default_rng(1)
    slow = values_of(20 + np.cumsum(rng.normal(0, 0.02, 2000)))
    noise = values_of(rng.normal(30, 10, 2000))
    switch = values_of((np.arange(100) // 30 % 2).astype(float))
    assert guess("x17", None, values=slow).quantity == "temperature"
    assert guess("x17", None, values=slow).questions
    assert guess("x17", None, values=noise).quantity is None
    assert guess("x17", None, values=switch).quantity == "state"
    assert guess("T_bearing_front", None, values=slow).comment() == "guess: name and values"
    kelvin = values_of(np.linspace(293.0, 303.0, 500))
    assert guess("T1", None, values=kelvin).unit == "K"
    unix = guess("/probe.t", None, values=values_of(1.77e9 + np.arange(500.0)))
    assert unix.quantity is None
    assert "1970" in (unix.why_not or "")
    counts = guess("T1", "degC", values=values_of(np.full(50, 30_000.0)))
    assert any("raw counts" in q for q in counts.questions)


def test_values_of_samples_add_up() -> None:
    one, two = values_of(np.zeros(10)), values_of(np.ones(10))
    both = joined(one, two)
    assert both is not None
    assert both.switch
    assert joined(None, two) == two
    assert values_of(np.array(["a"], dtype=object)) is None
    assert values_of(np.full(3, np.nan)) is None


@pytest.mark.parametrize(
    ("signal", "unit", "name"),
    [
        ("1 s/Last [%]", "%", "Last"),
        ("Spindel/Last [%]", "%", "Spindel_Last"),
        ("T_bed/Last", None, "T_bed_Last"),
        ("T_bed/Max", "degC", "T_bed_Max"),
    ],
)
def test_a_load_in_german_below_an_interval_is_no_statistic(signal: str, unit: str | None, name: str) -> None:
    assert wished_name(signal, guess(signal, unit, "float64")) == name


@pytest.mark.parametrize("name", ["ΔZ", "\u2206Z", "δz", "Δ Z", "Prova S4000/ΔZ", "ΔZ_tcp", "ΔZ1"])
def test_a_greek_delta_before_a_letter_is_a_difference(name: str) -> None:
    found = guess(name, "µm", "float64", values_of(np.linspace(-30, 5, 200)))
    assert (found.quantity, found.axis) == ("displacement", "Z")
    assert words("ΔT front") == "delta t front"
    assert words("Δεδομένα").startswith("δ")


@pytest.mark.parametrize(
    ("signal", "name"),
    [("ns=2;s=Feed_X", "Feed_X"), ("nsu=urn:x;s=Spindle.T", "Spindle.T"), ("ns=2;s=7", "ns=2;s=7")],
)
def test_the_space_of_names_of_a_node_is_no_part_of_its_name(signal: str, name: str) -> None:
    assert wished_name(signal, guess(signal, None)) == name
