"""Long tables that say the unit of each row, in a column of its own or behind the value."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError

from .logs import read_long, stamp, values

N = 40


@pytest.mark.parametrize(
    ("header", "units"), [("Einheit", True), ("E", True), ("U", True), ("Einh.", True), ("R", False)]
)
def test_a_column_of_units_is_known_by_its_header_or_by_a_short_one_and_its_words(
    tmp_path: Path, header: str, units: bool
) -> None:
    said = {"T_vorn": "°C", "p_oel": "bar"}
    rows = [f"{stamp(k)},{tag},{20 + k / 8},{unit}" for k in range(N) for tag, unit in said.items()]
    data = read_long(tmp_path, f"time,tag,value,{header}", rows)
    assert {s.name: s.unit for s in data.recording.signals} == (said if units else dict.fromkeys(said))


def test_a_short_header_over_words_that_are_no_units_says_none(tmp_path: Path) -> None:
    rows = [f"{stamp(k)},{tag},{20 + k / 8},{word}" for k in range(N) for tag, word in (("T1", "bar"), ("T2", "ERR"))]
    data = read_long(tmp_path, "time,tag,value,E", rows)
    assert {s.unit for s in data.recording.signals} == {None}


def test_rows_in_units_that_convert_are_given_in_the_first_of_them(tmp_path: Path) -> None:
    rows = [
        f"{stamp(5 * k)},{t},{v},{u}"
        for k in range(N)
        for t, v, u in (
            ("T", 20.5 if k % 2 else 68.9, "degC" if k % 2 else "degF"),
            ("dZ", k / 8 if k < 20 else k / 8000, "µm" if k < 10 else "um" if k < 20 else "mm"),
            ("state", "auto", ""),
        )
    ]
    data = read_long(tmp_path, "Timestamp,Channel,Value,Unit", rows)
    assert {s.name: s.unit for s in data.recording.signals} == {"T": "degF", "dZ": "µm", "state": None}
    found = values(data)
    np.testing.assert_allclose(found["dZ"], [k / 8 for k in range(N)], rtol=1e-12)
    np.testing.assert_allclose(found["T"], 68.9)
    assert not data.losses
    assert any("'dZ' is given in µm, also where its rows say mm" in n for n in data.recording.notes)
    assert any("'T' is given in degF, also where its rows say degC" in n for n in data.recording.notes)


@pytest.mark.parametrize("header", ["timestamp,topic,payload", "Time,Tag,Value"])
def test_values_with_their_unit_behind_them_are_numbers_in_it(tmp_path: Path, header: str) -> None:
    rows = [
        f"{stamp(5 * k)},{tag},{cell}"
        for k in range(N)
        for tag, cell in (
            ("mc/T", f"{20 + k / 8:.3f} °C"),
            ("mc/n", '"1 234,5 rpm"'),
            ("mc/dZ", f"{k / 8} µm" if k < 20 else f"{k / 8000} mm"),
            ("mc/dX", f"{k / 8}"),
            ("mc/coolant", "ON" if k % 10 < 5 else "OFF"),
            ("mc/block", f"N{k} G1" if k % 3 else "10 mm"),
        )
    ]
    data = read_long(tmp_path, header, [*rows, f"{stamp(5 * N)},mc/T,7 bar"])
    own = {s.name: (s.unit, s.dtype) for s in data.recording.signals}
    numbers = {"mc/T": "°C", "mc/n": "rpm", "mc/dZ": "µm", "mc/dX": None}
    words = dict.fromkeys(("mc/coolant", "mc/block"), (None, "str"))
    assert own == {name: (unit, "float64") for name, unit in numbers.items()} | words
    found = values(data)
    np.testing.assert_allclose(found["mc/T"][:N], [20 + k / 8 for k in range(N)])
    np.testing.assert_allclose(found["mc/dZ"][:N], [k / 8 for k in range(N)], rtol=1e-12)
    assert set(found["mc/n"]) == {1234.5}
    assert [loss.reason for loss in data.losses] == ["'mc/T': a value in 'bar', which does not convert to °C: '7'"]
    assert any("'mc/T' holds numbers with their unit ('20.000 °C')" in n for n in data.recording.notes)


def test_values_whose_units_do_not_convert_stay_words(tmp_path: Path) -> None:
    rows = [f"{stamp(5 * k)},{t},{k} {'bar' if t == 'p' and k % 2 else 'rpm'}" for k in range(N) for t in ("p", "n")]
    own = {s.name: (s.unit, s.dtype) for s in read_long(tmp_path, "Time,Tag,Value", rows).recording.signals}
    assert own == {"p": (None, "str"), "n": ("rpm", "float64")}


@pytest.mark.parametrize("word", ["n/a", "-", "NaN"])
def test_a_word_for_nothing_is_no_second_unit(tmp_path: Path, word: str) -> None:
    rows = [f"{stamp(5 * k)},T,{k / 8},{word if k % 7 == 0 else 'degC'}" for k in range(N)]
    data = read_long(tmp_path, "Timestamp,Channel,Value,Unit", [*rows, f"{stamp(5 * N)},dZ,1.5,um"])
    assert {s.name: s.unit for s in data.recording.signals} == {"T": "degC", "dZ": "um"}
    np.testing.assert_allclose(values(data)["T"][:N], [k / 8 for k in range(N)])
    assert not data.losses


def test_rows_in_units_that_do_not_convert_are_refused_or_lost(tmp_path: Path) -> None:
    rows = [f"{stamp(5 * k)},{t},{k / 8},um" for k in range(N) for t in ("dX", "dZ")]
    with pytest.raises(FormatError, match="'dZ' has several units"):
        read_long(tmp_path, "Timestamp,Channel,Value,Unit", [*rows[:-1], rows[-1].replace("um", "degC")])


def test_a_unit_behind_the_first_look_converts_or_is_a_loss(tmp_path: Path) -> None:
    rows = [
        f"{stamp(k // 2 / 50)},{t},{k / 8},um{' ' * 100}" for k in range(120_000) for t in ("dX", "dZ")[k % 2 :][:1]
    ]
    rows[60_001] = rows[60_001].replace("um", "mm")
    rows[60_003] = rows[60_003].replace("um", "degC")
    data = read_long(tmp_path, "Timestamp,Channel,Value,Unit", rows)
    assert [loss.reason for loss in data.losses] == [
        "'dZ': a value in 'degC', which does not convert to um: '7500.375'"
    ]
    assert 60_001 / 8 * 1000 in values(data)["dZ"]
