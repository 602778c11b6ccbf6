"""The signal that a campaign file means."""

from __future__ import annotations

import pytest

from thermodata.errors import UsageError
from thermodata.plugin import Signal
from thermodata.reader.finding.match import match_signal

SIGNALS = [
    Signal(n, s)
    for n, s in [
        ("Eddy/Z", "Eddy"),
        ("Eddy/Y", "Eddy"),
        ("Temp/T01 [degC]", "Temp"),
        ("ch3(um)", "table"),
        ("CH3", "table"),
        ("fast/Z", "fast"),
        ("nActSpeed", "nc"),
    ]
]


@pytest.mark.parametrize(
    ("wanted", "found"),
    [
        ("Eddy/Z", "Eddy/Z"),
        ("Y", "Eddy/Y"),
        ("Temp/T01", "Temp/T01 [degC]"),
        ("T01", "Temp/T01 [degC]"),
        ("ch3(um)", "ch3(um)"),
        ("ch3", "ch3(um)"),
        ("CH3", "CH3"),
        ("eddy/z", "Eddy/Z"),
        ("nactspeed", "nActSpeed"),
        ("fast:Z", "fast/Z"),
    ],
)
def test_exact_then_without_unit_then_the_last_part_then_any_case(wanted: str, found: str) -> None:
    assert match_signal(wanted, SIGNALS).name == found


def test_two_that_fit_are_an_error_with_both() -> None:
    with pytest.raises(UsageError) as caught:
        match_signal("Z", SIGNALS)
    assert "Eddy:Eddy/Z, fast:fast/Z" in str(caught.value)


@pytest.mark.parametrize("wanted", ["Eddy_Z", "eddy_z"])
def test_what_is_advised_is_meant_alone(wanted: str) -> None:
    signals = [Signal("Eddy_Z", "data"), Signal("Eddy_Z", "data@2"), *SIGNALS]
    with pytest.raises(UsageError) as caught:
        match_signal(wanted, signals)
    assert caught.value.hint == "write 'data:Eddy_Z' or 'data@2:Eddy_Z'"
    assert match_signal("data@2:Eddy_Z", signals).stream == "data@2"
    with pytest.raises(UsageError, match="write 'Eddy/Z' or 'fast/Z'"):
        match_signal("Z", SIGNALS)


def test_none_that_fits_names_the_nearest() -> None:
    with pytest.raises(UsageError, match="did you mean 'nActSpeed'"):
        match_signal("nActSped", SIGNALS)
    with pytest.raises(UsageError, match="the file has none"):
        match_signal("x", [])


@pytest.mark.parametrize(
    ("wanted", "inside", "encoding"),
    [("Pièce", "Pičce [°C]", "cp1252"), ("Palier arrière broche", "log/Palier arričre broche", "cp1252"),
     ("Otáčky", "Otáèky", "cp1250")],
)  # fmt: skip
def test_a_name_that_was_read_in_another_encoding_says_which_to_declare(
    wanted: str, inside: str, encoding: str
) -> None:
    with pytest.raises(UsageError, match=f"declare 'encoding: {encoding}' for the source"):
        match_signal(wanted, [Signal(inside, "log"), *SIGNALS])


@pytest.mark.parametrize("wanted", ["bCoolant", "bcoolant", "bCoolant [1]", "nc:bCoolant [1]"])
def test_a_unit_of_one_may_be_left_out(wanted: str) -> None:
    signals = [Signal("nc/bCoolant [1]", "nc"), Signal("nc/bDoor [1]", "nc"), Signal("nc/n [1/min]", "nc")]
    assert match_signal(wanted, signals).name == "nc/bCoolant [1]"


@pytest.mark.parametrize("others", [["T [1]", "T [2]"], ["T [2]"], ["T[1]"], ["T [1]", "T [1]"]])
def test_numbers_of_signals_are_no_unit(others: list[str]) -> None:
    with pytest.raises(UsageError, match="no signal 'T'"):
        match_signal("T", [Signal(name, "a") for name in others])
