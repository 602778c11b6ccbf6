"""Units with factors, and units that say nothing: what is drafted ingests as what the file holds, or is asked."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from tests.commands import Say
from thermodata.draft.signals.guess import guess
from thermodata.draft.signals.values import Values
from thermodata.reader.text import split_unit


@pytest.mark.parametrize(
    ("header", "name", "unit"),
    [
        ("nSp [10^3/min]", "nSp", "10^3/min"),
        ("T_Lager_vorn [1/10 °C]", "T_Lager_vorn", "1/10 °C"),
        ("dY (0,1 µm)", "dY", "0,1 µm"),
        ("T_Bett [°C*10]", "T_Bett", "°C*10"),
        ("n [x1000 rpm]", "n", "x1000 rpm"),
        ("dZ [µm ×0,1]", "dZ", "µm ×0,1"),
        ("dZ [um*0.01]", "dZ", "um*0.01"),
        ("Halle [m x 0,5 m]", "Halle [m x 0,5 m]", None),
        ("dX [100 um]", "dX [100 um]", None),
        ("nckServoData [u1; 1]", "nckServoData [u1; 1]", None),
    ],
)
def test_a_factor_in_brackets_belongs_to_the_unit(header: str, name: str, unit: str | None) -> None:
    assert split_unit(header) == (name, unit)


def test_a_factor_whose_sense_nobody_knows_is_asked() -> None:
    said = guess("T_Bett [°C*10]", "°C*10")
    assert (said.quantity, said.unit) == ("temperature", None)
    assert "'°C*10', which is no unit known here" in said.questions[0]


def test_a_factor_behind_the_unit_is_refused_in_brackets_as_in_a_row_of_units(tmp_path: Path, say: Say) -> None:
    folder = _folder(tmp_path, "Zeit;dZ [µm ×0,1]", lambda k: str(k))
    say("init", folder)
    file = folder / "campaign.yaml"
    sign = "calibrations:\n  s: {kind: scale, axis: Z, gain: 1 um/um, facing: +Z, increases_with: gap}\ntests:"
    text = file.read_text(encoding="utf-8").replace("axis: Z,", "axis: Z, calibration: s,").replace("tests:", sign)
    file.write_text(text, encoding="utf-8")
    said = say("--store", tmp_path / "store", "ingest", file)
    assert "µm ×0,1" in said.out
    assert "losses" in said.out


def _folder(folder: Path, header: str, row: Callable[[int], str]) -> Path:
    (folder / "raw").mkdir(parents=True)
    lines = [header, *(f"12.06.2025 07:{k // 60:02d}:{k % 60:02d};{row(k)}" for k in range(240))]
    (folder / "raw" / "01_lauf.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return folder


def test_thousands_of_turns_and_tenths_of_a_degree_are_ingested_as_such(tmp_path: Path, say: Say) -> None:
    folder = _folder(
        tmp_path / "a",
        "Zeit;nSp [10^3/min];T_Lager_vorn [1/10 °C];Auslastung Spindel [-]",
        lambda k: f"{8 * (k > 60)},000;{194 + k // 40};0,{k % 9}00",
    )
    assert say("init", folder).code == 0
    store = tmp_path / "store"
    said = say("--store", store, "ingest", folder / "campaign.yaml")
    assert said.code == 0, said.err
    shown = say(
        "--store", store, "sql", "--csv", "SELECT channel, max(value) m FROM sample GROUP BY ALL ORDER BY channel"
    ).out
    found = dict(re.findall(r"^(\w+),([\d.]+)", shown, re.MULTILINE))
    assert {k: pytest.approx(float(v)) for k, v in found.items()} == {
        "nSp": 8000.0,
        "T_Lager_vorn": 19.9,
        "Auslastung_Spindel": 80.0,  # a share of 1 in per cent
    }


def test_a_share_that_may_be_of_one_is_asked_and_one_of_a_hundred_is_said(tmp_path: Path, say: Say) -> None:
    asked = _folder(tmp_path / "a", "Zeit;Auslastung Spindel [-];T_Halle [°C]", lambda k: f"0,{k % 9};20,{k % 3}")
    say("init", asked)
    assert "1 is read as 100 %" in (asked / "campaign.yaml").read_text(encoding="utf-8")
    percent = _folder(tmp_path / "b", "Zeit;Auslastung Spindel [-];T_Halle [°C]", lambda k: f"{k % 90},5;20,{k % 3}")
    say("init", percent)
    assert 'unit: "%", instead_of: "-"' in (percent / "campaign.yaml").read_text(encoding="utf-8")
    assert say("--store", tmp_path / "store", "ingest", percent / "campaign.yaml").code == 0


@pytest.mark.parametrize("unit", ["°C/10", "0.1 °C", "1/10 °C", "x0.1 degC"])
def test_tenths_of_a_degree_are_never_kelvin(unit: str, tmp_path: Path, say: Say) -> None:
    folder = _folder(tmp_path / "a", f"Zeit;T_Lager_vorn [{unit}]", lambda k: f"{230 + k // 40}")
    assert say("init", folder).code == 0
    store = tmp_path / "store"
    assert say("--store", store, "ingest", folder / "campaign.yaml").code == 0
    shown = say("--store", store, "sql", "--csv", "SELECT max(value) m FROM sample").out
    assert float(shown.split()[-1]) == pytest.approx(23.5)


def test_a_temperature_without_a_unit_that_is_too_cold_for_kelvin_is_asked() -> None:
    tenths = Values(500, 230, 240, 235, 1, 0.5, 9, True, 230, 230)
    assert (guess("T_Lager_vorn", None, values=tenths).unit) is None
    kelvin = replace(tenths, low=293.15, high=296.4, median=295, whole=False)
    assert (guess("T_Lager_vorn", None, values=kelvin).unit) == "K"
    either = replace(tenths, low=285, high=300, median=290)
    assert "K, or tenths of a degree" in guess("T_Lager_vorn", None, values=either).questions[0]


@pytest.mark.parametrize(
    ("header", "unit", "truth"),
    [
        ("A axis speed [°/s]", "°/s", 10.0),
        ("Drehzahl C-Achse [Grad/s]", "Grad/s", 10.0),
        ("Drehzahl A [°/min]", "°/min", 1 / 6),
        ("Drehzahl Spindel [1/h]", "1/h", 1.0),
    ],
)
def test_a_speed_in_degrees_or_by_the_hour_is_ingested_in_rpm(
    header: str, unit: str, truth: float, tmp_path: Path, say: Say
) -> None:
    folder = _folder(tmp_path / "a", f"Zeit;{header}", lambda k: f"{60 * (k > 60)},0")
    assert say("init", folder).code == 0
    drafted = (folder / "campaign.yaml").read_text(encoding="utf-8")
    assert re.search(rf'unit: "?{re.escape(unit)}"?[,}}]', drafted)
    store = tmp_path / "store"
    assert say("--store", store, "ingest", folder / "campaign.yaml").code == 0
    shown = say("--store", store, "sql", "--csv", "SELECT channel, max(value) m FROM sample GROUP BY ALL").out
    channel, value = shown.split()[-1].split(",")
    assert channel != "min"
    assert float(value) == pytest.approx(truth)


@pytest.mark.parametrize(("unit", "size"), [("K", 1.0), ("mK", 0.001), ("0,1 K", 0.1), ("°K", 1.0)])
def test_few_kelvin_are_a_difference_in_any_size_of_them(unit: str, size: float) -> None:
    few = Values(500, 1 / size, 3 / size, 2 / size, 0.1, 0.5, 9, False, 1 / size, 1 / size)
    assert guess("T_Lager_vorn", unit, values=few).quantity == "temperature_difference"
    much = replace(few, low=293 / size, high=300 / size, median=295 / size)
    assert guess("T_Lager_vorn", unit, values=much).quantity == "temperature"


def test_a_unit_of_slopes_is_a_tilt_where_the_name_says_so() -> None:
    for unit in ("µm/m", "μm/m", "mm/m", "arcsec", "mrad"):
        assert guess("Inclinazione montante", unit).quantity == "tilt"
        assert guess("Segnale 7", unit).quantity is None


@pytest.mark.parametrize("name", ["Chiller saída ºC", "Retorno fluido de corte ºC", "Hallenluft °C"])
def test_degrees_at_the_end_of_a_name_are_its_unit(name: str) -> None:
    said = guess(name, None)
    assert (said.quantity, said.unit) == ("temperature", name[-2:])
    assert not any(q.startswith("unit") for q in said.questions)
