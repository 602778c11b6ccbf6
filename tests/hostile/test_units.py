"""Units that files state, that campaign files state, and that differ."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.schema.quantity import linear_conversion

from .conftest import Lab
from .test_times import stamps

TIMES = stamps("2026-03-02 08:00:00", 10, 40)
POWER = {"signal": "P", "quantity": "power", "at": "spindle"}


def csv(unit: str, value: str = "2.5") -> str:
    return f"time;P [{unit}]\n" + "".join(f"{t};{value}\n" for t in TIMES)


def test_a_declared_unit_that_contradicts_the_file_is_refused_until_it_says_so(lab: Lab) -> None:
    lab.write("raw/a.csv", csv("kW"))
    said = lab.ingest({"P1": {**POWER, "unit": "W"}})
    assert said.code == 3
    assert "the file says 'kW', the campaign file says 'W'" in said.out + said.err
    assert np.isnan(lab.values("P1")[1]).all()
    assert lab.ingest({"P1": POWER}).code == 0
    assert lab.values("P1")[1][0] == 2.5
    assert lab.ingest({"P1": {**POWER, "unit": "W", "instead_of": "kW"}}).code == 0
    assert lab.values("P1")[1][0] == 0.0025
    said = lab.ingest({"P1": {**POWER, "unit": "W", "instead_of": "MW"}})
    assert said.code == 3
    assert "not 'MW'" in said.out + said.err


@pytest.mark.parametrize("spelling", ["kW", "KW", "kilowatt"])
def test_the_same_unit_in_other_words_is_no_contradiction(lab: Lab, spelling: str) -> None:
    lab.write("raw/a.csv", csv("kW"))
    assert lab.ingest({"P1": {**POWER, "unit": spelling}}).code == 0
    assert lab.values("P1")[1][0] == 2.5


def test_files_of_one_source_in_two_units_are_not_joined(lab: Lab) -> None:
    lab.write("raw/a.csv", csv("kW").replace(" [kW]", "\n;kW"))
    lab.write("raw/b.csv", csv("W").replace(" [W]", "\n;W").replace("2026-03-02", "2026-03-03"))
    said = lab.ingest({"P1": POWER})
    assert said.code == 3
    assert "'kW' in raw/a.csv" in said.out + said.err
    assert "'W' in raw/b.csv" in said.out + said.err
    assert np.isnan(lab.values("P1")[1]).all()


@pytest.mark.parametrize(
    ("written", "target", "factor"),
    [
        ("kNm", "N m", 1000.0),
        ("Ncm", "N m", 0.01),
        ("mNm", "N m", 0.001),
        ("m3/h", "l/min", 1000 / 60),
        ("m³/h", "l/min", 1000 / 60),
        ("cm3/min", "l/min", 0.001),
        ("kOhm", "Ohm", 1000.0),
        ("MOhm", "Ohm", 1e6),
        ("mOhm", "Ohm", 1e-3),
        ("kHz", "rpm", 60_000.0),
    ],
)
def test_compound_units_as_labs_write_them(written: str, target: str, factor: float) -> None:
    assert linear_conversion(written, target) == (pytest.approx(factor), 0.0)
