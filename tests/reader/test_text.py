"""Encodings, units in headers, decimal marks."""

from __future__ import annotations

import pytest

from thermodata.errors import FormatError
from thermodata.reader.text import decimal_mark, decode, decode_head, last_line_is_whole, split_unit


@pytest.mark.parametrize(
    ("text", "written", "found"),
    [
        ("čas;teplota vřetena [°C]", "utf-8", "utf-8"),
        ("čas;teplota vřetena [°C]", "utf-8-sig", "utf-8-sig"),
        ("čas;teplota vřetena [°C]", "utf-16", "utf-16"),
        ("Zeit;Temp [Grd C]", "utf-16-le", "utf-16-le"),
        ("Zeit;Temp [Grd C]", "utf-16-be", "utf-16-be"),
        ("čas;teplota ložiska [°C];posunutí [µm]", "cp1250", "cp1250"),
        ("Durchfluß [m³/h];Fläche [m²]", "cp1252", "cp1252"),
        ("durée;température à l'entrée [µm]", "cp1252", "cp1252"),
    ],
)
def test_decodes_what_labs_write(text: str, written: str, found: str) -> None:
    got, encoding, note = decode(text.encode(written), None)
    assert got == text
    assert encoding == found
    assert (note is None) == (found in ("utf-8", "utf-8-sig", "utf-16"))


def test_micro_survives_any_single_byte_encoding() -> None:
    assert decode("dz [µm];T [°C]".encode("cp1252"), None)[0] == "dz [µm];T [°C]"


def test_declared_encoding_wins_and_a_wrong_one_is_refused() -> None:
    assert decode(b"\xf8", "cp1252") == ("ø", "cp1252", None)
    with pytest.raises(FormatError, match="does not decode"):
        decode(b"\xf8 ab", "utf-8")
    with pytest.raises(FormatError, match="no encoding 'klingon'"):
        decode(b"a", "klingon")


def test_head_may_end_inside_a_character_and_binary_is_none() -> None:
    assert decode_head("ab°".encode()[:-1]) == "ab"
    assert decode_head("ab°C".encode("cp1250")) == "ab°C"
    assert decode_head("ab°C".encode("utf-16")) == "ab°C"
    assert decode_head(b"TDSm\x0e\0\0\0\x69\x12\0\0\xff\xff") is None


@pytest.mark.parametrize(
    ("header", "name", "unit"),
    [
        ("ch3(um)", "ch3", "um"),
        ("Temp [degC]", "Temp", "degC"),
        ("時間(s)", "時間", "s"),
        ("時間（s）", "時間", "s"),
        ("speed[U/min]", "speed", "U/min"),
        ("T1 [Grd C]", "T1", "Grd C"),
        ("q (W/m²)", "q", "W/m²"),
        ("flow [m3/h]", "flow", "m3/h"),
        ("M (N m)", "M", "N m"),
        ("load [%]", "load", "%"),
        ("y [µm]", "y", "µm"),
        ("odd [frobs]", "odd", "frobs"),
        ("Excitation (Trigger)", "Excitation (Trigger)", None),
        ("/Nck/!SD/nckServoDataActCurr32 [u1; 1]", "/Nck/!SD/nckServoDataActCurr32 [u1; 1]", None),
        ("T[2]", "T[2]", None),
        ("T (front)", "T (front)", None),
        ("plain", "plain", None),
        ("(um)", "(um)", None),
        ("", "", None),
    ],
)
def test_unit_in_brackets(header: str, name: str, unit: str | None) -> None:
    assert split_unit(header) == (name, unit)


@pytest.mark.parametrize(
    ("header", "name", "unit"),
    [
        ("Temp, °C (LGR S/N: 10384870, SEN S/N: 10384870, LBL: hall air)", "Temp hall air", "°C"),
        ("RH, % (LGR S/N: 10384870, SEN S/N: 10384870)", "RH", "%"),
        ("Host Connected (LGR S/N: 10384870)", "Host Connected", None),
        ("Kanal 1 [°C] vorn", "Kanal 1 vorn", "°C"),
        ("TCP [um](1)", "TCP (1)", "um"),
        ("101 (C)- T_front", "101 T_front", "C"),
        ("103 (Vdc)- gap", "103 gap", "Vdc"),
        ("M00: °C", "M00", "°C"),
        ("M02: V", "M02", "V"),
        ("M00: Lager", "M00: Lager", None),
        ("M00: T", "M00: T", None),
        ("Achse [C] Ist", "Achse [C] Ist", None),
        ("°C [bed]", "bed", "°C"),
        ("degC (spindle front)", "spindle front", "degC"),
        ("µm [Z]", "Z", "µm"),
        ("°C [K]", "°C", "K"),
        ("°C [1]", "°C [1]", None),
        ("V [left]", "V", "left"),
        ("°C (a) (b)", "°C (a) (b)", None),
        ("T[2] mean", "T[2] mean", None),
        ("Motor (A) current", "Motor (A) current", None),
    ],
)
def test_the_unit_of_a_header_may_stand_within_it(header: str, name: str, unit: str | None) -> None:
    assert split_unit(header) == (name, unit)


def test_decimal_mark_from_the_data() -> None:
    assert decimal_mark(["1", "2,5", "x"]) == ","
    assert decimal_mark(["1", "2.5e-3"]) == "."
    assert decimal_mark(["1", "2"]) is None
    with pytest.raises(FormatError, match="a decimal point and with a decimal comma"):
        decimal_mark(["1,5", "2.5"])


@pytest.mark.parametrize(
    ("line", "before", "whole"),
    [
        ("3;12.75", "2;12.50", True),
        ("3;12,75", "2;9,50", True),
        ("3;12.7", "2;12.50", False),
        ("3", "2;12.50", False),
        ("3;100", "2;900", False),
        ("3;o", "2;ok", False),
        ("3;", "2;", False),
        ("3;AUTO", "2;AUTO", True),
    ],
)
def test_a_last_line_without_end_is_trusted_where_nothing_can_be_missing(line: str, before: str, whole: bool) -> None:
    assert last_line_is_whole(line, before, ";") is whole
