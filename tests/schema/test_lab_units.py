"""Units as labs write them, each against the truth: read exactly, or no unit, never another one."""

from __future__ import annotations

import math

import pytest

from thermodata.draft.signals.units import quantities_of
from thermodata.errors import UsageError
from thermodata.reader.text import split_unit
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.unit import is_unit

_DEG, _RAD = 1 / 360, 1 / (2 * math.pi)  # turns

_EXACT: list[tuple[str, str, float]] = [
    *((u, "rpm", 60 * _DEG) for u in ("°/s", "deg/s", "Grad/s", "grad/s", "º/s", "deg / s")),
    *((u, "rpm", _DEG) for u in ("°/min", "deg/min", "Grad/min")),
    *((u, "rpm", 60 * _RAD) for u in ("rad/s", "rad / s")),
    ("mrad/s", "rpm", 0.06 * _RAD),
    ("rad/min", "rpm", _RAD),
    *((u, "rpm", 60.0) for u in ("U/s", "1/s", "s-1", "s⁻¹", "/s", "tr/s", "rev/s", "r/s", "Hz", "cps", "rps", "㎐")),
    *((u, "rpm", 1 / 60) for u in ("1/h", "U/h", "h-1", "rev/h")),
    *((u, "rpm", 1 / 1440) for u in ("1/d", "U/d")),
    ("mHz", "rpm", 0.06),
    ("kHz", "rpm", 60_000.0),
    *(
        (u, "rpm", 1.0)
        for u in ("min⁻¹", "min−1", "ｒｐｍ", "rot/min", "obr/min", "giri/min", "tours/min", "Umdr./min")
    ),
    *(
        (u, "rpm", 1.0)
        for u in (
            "vueltas/min",
            "varv/min",
            "omw/min",
            "omdr/min",
            "dev/dk",
            "tr/mn",
            "ford/perc",
            "об/мин",
            "转/分",
            "r.p.m.",
        )
    ),
    *((u, "rpm", 1000.0) for u in ("krpm", "kRPM", "kU/min")),
    *((u, "kW", 0.73549875) for u in ("PS", "CV", "ＰＳ")),
    *((u, "kW", 0.745699871582) for u in ("hp", "HP")),
    ("㎾", "kW", 1.0),
    ("kVA", "kW", 1.0),
    *((u, "l/min", 3.785411784) for u in ("gpm", "GPM", "gal/min", "US gpm")),
    *((u, "l/min", 1.0) for u in ("L/min", "ℓ/min", "lpm", "LPM", "㍑/min")),
    *((u, "l/min", 1000 / 60) for u in ("m3/h", "m³/h", "㎥/h", "m^3/h")),
    ("cfm", "l/min", 28.316846592),
    *((u, "um", 25.4) for u in ("mil", "mils", "thou")),
    *((u, "um", 1000.0) for u in ("㎜", "ｍｍ", "MM", "мм", "milímetros", "millimetri")),
    *((u, "um", 0.0254) for u in ('µ"', 'u"', "μ″", "µ”", "µ''", "µ′′", "µin.", "u in", "micro-inch", "microinches")),
    *(
        (u, "um", 1.0)
        for u in (
            "㎛",
            "μ",
            "µ",
            "mkm",
            "мкм",
            "micrometri",
            "micromètres",
            "mikrometr",
            "Mikron",
            "μｍ",
            "µm\u200b",
            "\ufeffµm",
        )
    ),
    *((u, "bar", 0.980665) for u in ("kgf/cm2", "kgf/cm²", "㎏f/㎠", "kg/cm2", "kp/cm²", "at")),
    *((u, "bar", 10.0) for u in ("MPa", "㎫", "N/mm²", "N/mm2")),
    *((u, "bar", 0.01) for u in ("kPa", "㎪", "KPa")),
    *((u, "bar", 1.0) for u in ("bar(g)", "barg", "bar")),
    ("Torr", "bar", 101325 / 760 / 1e5),
    *((u, "N m", 1.3558179483314) for u in ("ft-lb", "lb-ft", "lbf·ft", "ft.lb", "lbf ft")),
    ("in-lb", "N m", 0.1129848290276),
    *((u, "N m", 1.0) for u in ("N-m", "N−m", "N·m")),
    *((u, "N m", 9.80665) for u in ("kgf·m", "kgfm", "kgf.m")),
    *((u, "degC", 1.0) for u in ("ºC", "℃", "°Ｃ", "oC", "deg_C", "Grad C", "°Cel")),
    *((u, "degC", 0.1) for u in ("°C/10", "0.1 °C", "1/10 °C", "x0.1 degC", "×0,1 °C", "0.1ºC", "℃/10")),
    ("mm/1000", "um", 1.0),
    *((u, "%", 1.0) for u in ("％", "% r.F.", "Proz.")),
    *((u, "urad", 1.0) for u in ("µm/m", "μm/m", "um/m", "㎛/m")),
    ("Grad", "deg", 1.0),
    *((u, "degC", 1.0) for u in ("st. C", "gradi C", "Cel", "摂氏", "°С", "° С")),  # the last with a Cyrillic letter
    ("U.p.M.", "rpm", 1.0),
    ("gon", "deg", 0.9),
    ("㏀", "Ohm", 1000.0),
    ("ipm", "m/min", 0.0254),
    *((u, "m/min", 60.0) for u in ("m∕s", "m⁄s", "m÷s", "m／s")),
    *((u, "rpm", 1.0) for u in ("1⁄min", "1∕min", "min–1")),
    *((u, "K", 1.0) for u in ("ΔK", "∆K", "Δ°C", "∆°C", "∆C")),
    ("W/㎡", "W/m2", 1.0),
]


@pytest.mark.parametrize(("written", "target", "factor"), _EXACT)
def test_a_unit_is_what_a_lab_means_by_it(written: str, target: str, factor: float) -> None:
    assert linear_conversion(written, target) == pytest.approx((factor, 0.0), rel=1e-9)
    assert split_unit(f"Kanal 7 [{written}]") == ("Kanal 7", written)


@pytest.mark.parametrize(
    "written",
    [
        *("Mm", "hm", "Min", "MIN", "PA", "PSi", "cd", "dc", "dez", "Dez", "ch", "my", "slpm", "scfm", "Nl/min"),
        *("%FS", "dC", "kC", "m°C", "kVAr", "nMm", "Gs", "Tm", "EV", "das", "mmin", "ms-1"),
    ],
)
def test_what_only_a_table_of_prefixes_makes_a_unit_is_none(written: str) -> None:
    assert not is_unit(written)
    assert quantities_of(written) == ()


@pytest.mark.parametrize(
    ("written", "target"),
    [("mm/U", "um"), ("mm/rev", "um"), ("kWh", "rpm"), ("g/min", "rpm"), ("V/min", "rpm"), ("gpm", "m/min")],
)
def test_a_length_by_the_turn_is_no_length(written: str, target: str) -> None:
    with pytest.raises(UsageError, match="does not convert"):
        linear_conversion(written, target)


def test_a_torque_within_a_unit_is_one() -> None:
    assert linear_conversion("um/Nm", "um/(N*m)") == (1.0, 0.0)
    assert linear_conversion("kNm/deg", "Nm/deg") == pytest.approx((1000.0, 0.0))


def test_an_energy_is_no_torque_and_a_rate_no_speed_unless_the_name_says_so() -> None:
    assert [quantities_of(u) for u in ("kWh", "1/h", "MHz", "s⁻¹", "Hz", "µm/m")] == [()] * 6


@pytest.mark.parametrize(
    "header", ["Pumpe (HP)", "Ventil (CV)", "Wasser (in)", "Luft (at)", "Eingang [1]x", 'd["n"]', "W[%MW100]"]
)
def test_words_in_round_brackets_and_addresses_are_no_units(header: str) -> None:
    assert split_unit(header) == (header, None)


@pytest.mark.parametrize("unit", ["0.05 °C", "%FS", '"', "°Brix"])
def test_what_holds_a_sign_of_a_unit_is_one_that_is_not_known(unit: str) -> None:
    assert split_unit(f"Kanal 7 [{unit}]") == ("Kanal 7", unit)
    assert not is_unit(unit)


@pytest.mark.parametrize(
    "unit",
    [
        "?m",
        "\ufffdm",
        "¦m",
        "˙m",
        "m?",
        'mm"',
        'm"',
        "mm'",
        "µm;",
        "$m",
        "#m",
        "h:min",
        "m%",
        "µ%",
        "%m",
        "rpm%",
        "m√",
        "''",
    ],
)
def test_a_unit_with_a_sign_that_no_unit_has_is_none(unit: str) -> None:
    assert not is_unit(unit)
    assert quantities_of(unit) == ()
    for target in ("um", "mm", "rpm", "%", "s"):
        with pytest.raises(UsageError, match="does not convert"):
            linear_conversion(unit, target)


@pytest.mark.parametrize("unit", ["W/(m²·K)", "W/m²·K", "µm/(m·K)", "K⁻¹", "%/K", "‰", "mV/V", "Pa·s", "m^3/h", "mm."])
def test_strokes_dots_powers_and_brackets_are_signs_of_units(unit: str) -> None:
    assert is_unit(unit)


def test_a_difference_of_temperatures_is_no_temperature() -> None:
    assert quantities_of("∆K") == quantities_of("Δ°C") == ("temperature_difference",)


@pytest.mark.parametrize("unit", ["<mm>", "{mm}", "'mm'", "“mm”", "[mm]", " mm "])
def test_what_stands_around_a_unit_is_no_part_of_it(unit: str) -> None:
    assert linear_conversion(unit, "um") == (1000.0, 0.0)
