"""What labs write for a unit, and how pint spells it.

Pint misreads several of the left side without a word (1/min as 0.159 rpm, U/min as enzyme units, Grd C as coulombs), so
this table comes first. Keys are casefolded, with blanks removed; a unit that case distinguishes (mW and MW) stays out.
"""

from __future__ import annotations

import re
from functools import lru_cache

from thermodata.schema.units.in_words import in_words
from thermodata.schema.units.signs import bare_unit

UNIT_SPELLING: dict[str, str] = {
    "1/min": "rpm",
    "u/min": "rpm",
    "ot/min": "rpm",
    "ot./min": "rpm",
    "min-1": "rpm",
    "min^-1": "rpm",
    "min⁻¹": "rpm",
    "rev/min": "rpm",
    "r/min": "rpm",
    "rpm": "rpm",
    "r.p.m.": "rpm",
    "r.p.m": "rpm",
    "krpm": "krpm",
    "upm": "rpm",
    "u.p.m.": "rpm",
    "tr/min": "rpm",
    "/min": "rpm",
    "1/s": "turn/second",
    "u/s": "turn/second",
    "ot/s": "turn/second",
    "s-1": "turn/second",
    "s^-1": "turn/second",
    "rev/s": "turn/second",
    "rps": "turn/second",
    "hz": "turn/second",
    "khz": "kiloturn/second",
    "degc": "degC",
    "°c": "degC",
    "℃": "degC",
    "grdc": "degC",
    "celsius": "degC",
    "deg.c": "degC",
    "c": "degC",
    "c°": "degC",
    "°celsius": "degC",
    "gradc": "degC",
    "ºc": "degC",
    "degcelsius": "degC",
    "degreec": "degC",
    "degreesc": "degC",
    "degreescelsius": "degC",
    "stc": "degC",
    "st.c": "degC",
    "gradic": "degC",
    "cel": "degC",
    "摂氏": "degC",
    "°cel": "degC",
    "degrc": "degC",
    "degr.c": "degC",
    "deg_c": "degC",
    "grad_c": "degC",
    "oc": "degC",
    "degf": "degF",
    "degreef": "degF",
    "degreesf": "degF",
    "f": "degF",
    "°f": "degF",
    "fahrenheit": "degF",
    "um": "um",
    "µm": "um",
    "μm": "um",
    "micron": "um",
    "microns": "um",
    "micrometer": "um",
    "mikrometer": "um",
    "mikron": "um",
    "inches": "inch",
    "zoll": "inch",
    "pouce": "inch",
    "pouces": "inch",
    "pulgada": "inch",
    "pulgadas": "inch",
    "pollice": "inch",
    "pollici": "inch",
    "polegada": "inch",
    "polegadas": "inch",
    "дюйм": "inch",
    "дюймы": "inch",
    "英寸": "inch",
    "英吋": "inch",
    "インチ": "inch",
    "인치": "inch",
    "kelvins": "K",
    "δk": "delta_degC",
    "δ°c": "delta_degC",
    "δc": "delta_degC",
    "δ°f": "delta_degF",
    "watts": "W",
    "watt": "W",
    "amperes": "A",
    "pascals": "Pa",
    "radians": "rad",
    "prozent": "percent",
    "hertz": "turn/second",
    "mkm": "um",
    "мкм": "um",
    "мм": "mm",
    "°с": "degC",
    "квт": "kW",
    "mil": "thou",
    "mils": "thou",
    "urad": "urad",
    "µrad": "urad",
    "μrad": "urad",
    "um/m": "urad",
    "μm/m": "urad",
    "µm/m": "urad",
    "deg": "deg",
    "°": "deg",
    "gon": "gon",
    "grad": "deg",
    "volts": "V",
    "vdc": "V",
    "vac": "V",
    "adc": "A",
    "aac": "A",
    "volt": "V",
    "v": "V",
    "%": "percent",
    "percent": "percent",
    "pct": "percent",
    "proz": "percent",
    "%rh": "percent",
    "rh%": "percent",
    "rh": "percent",
    "%r.h.": "percent",
    "%rf": "percent",
    "%h": "percent",
    "%r.f.": "percent",
    "proz.": "percent",
    "pu": "per_unit",
    "p.u.": "per_unit",
    "p.u": "per_unit",
    "kw": "kW",
    "hp": "horsepower",
    "kpa": "kPa",
    "kgf/cm2": "kgf/cm**2",
    "kgf/cm²": "kgf/cm**2",
    "kg/cm2": "kgf/cm**2",
    "kg/cm²": "kgf/cm**2",
    "kp/cm2": "kgf/cm**2",
    "kp/cm²": "kgf/cm**2",
    "barg": "bar",
    "bar(g)": "bar",
    "bara": "bar",
    "bar(a)": "bar",
    "torr": "torr",
    "nm": "N*m",
    "n·m": "N*m",
    "n*m": "N*m",
    "n.m": "N*m",
    "newtons": "N",
    "w/m2": "W/m**2",
    "w/m²": "W/m**2",
    "w/m^2": "W/m**2",
    "ohm": "ohm",
    "ω": "ohm",
    "ohms": "ohm",
    "l/min": "l/min",
    "lpm": "l/min",
    "gpm": "gallon/min",
    "usgpm": "gallon/min",
    "cfm": "ft**3/min",
    "m/min": "m/min",
    "mm/min": "mm/min",
    "ipm": "inch/min",
    "fpm": "ft/min",
    "1": "dimensionless",
    "-": "dimensionless",
    "bool": "dimensionless",
    "": "dimensionless",
    "none": "dimensionless",
    "0/1": "dimensionless",
    "on/off": "dimensionless",
    "k": "K",
    "kelvin": "K",
    "°k": "K",
    "amps": "A",
    "ampere": "A",
    "amp": "A",
    "hours": "h",
    "hour": "h",
    "std": "h",
    "hod": "h",
    "secs": "s",
    "sec": "s",
    "sek": "s",
    "seconds": "s",
    "minutes": "min",
    "minuten": "min",
}

# in these the case of a letter counts: PS is a horse's power, ps a time; Mm is a thousand kilometres
_IN_THIS_CASE = {"PS": "metric_horsepower", "CV": "metric_horsepower", "MM": "mm"}
# turns and minutes as the languages of labs write them: varv/min, omw/min, dev/dk, об/мин, 转/分
_TURN = (
    r"(?:u|umdr|rev|revs|revoluciones|vueltas?|r|tr|tours?|giri|rot|rotações|obr|obrotów|ot|otáč(?:ek|ky)|otac(?:ek|ky)|o|"
    r"omdr|omw|toeren|varv|kierr|dev|devir|ford|fordulat|obrt|vrt|об|оборотов|转|轉|回転|turns?)\.?"
)
_MINUTES = ("mn", "dk", "dak", "perc", "мин", "分")
_TIME = rf"(?P<time>ms|s|sec|sek|秒|min|{'|'.join(_MINUTES)}|h|hr|d)"
_TURNS_PER = re.compile(rf"(?P<kilo>k?){_TURN}/{_TIME}\.?", re.IGNORECASE)
_PER_TIME = re.compile(rf"1?/{_TIME}")
_PER_TIME_RAISED = re.compile(r"(?P<time>s|min|h|d)(?:(?:\^|\*\*)?-1|⁻¹)")
_PER_TURN = re.compile(rf"(?P<length>mm|um|μm|in|inch)/{_TURN}", re.IGNORECASE)
_FOOT_POUND = re.compile(
    r"(?P<length>ft|in)[-.·*]?lbf?|lbf?[-.·*]?(?P<behind>ft|in)|(?P<kilo>kgf|kp)[.·*]?(?P<metric>m|cm)", re.IGNORECASE
)
_GRAD = re.compile(r"(?<![^\W\d_])grad(?![^\W\d_])", re.IGNORECASE)
_MICRO_INCH = re.compile(r"(?:u|μ|mi[ck]ro)-?(?:in(?:ch(?:es)?)?\.?|[\"″”]|''|′′)", re.IGNORECASE)


# of humidity: no other share is called so ('%H' is Almemo's)
_HUMID = frozenset({"%rh", "rh%", "rh", "%r.h.", "%rf", "%r.f.", "%h"})


def is_of_humidity(text: str) -> bool:
    """Whether a unit says of what it is a share: '%rF', '% r.H.', '%H'."""
    return bare_unit(text).casefold() in _HUMID


# of feeds and flows, whose minute is one of another language: 'mm/dk' in Turkish, 'l/perc' in Hungarian
_RATE_A_MINUTE = re.compile(rf"(?P<what>μm|um|mm|cm|m|l|in|inch)/(?:{'|'.join(_MINUTES)})\.?", re.IGNORECASE)


@lru_cache(maxsize=4096)
def spelled(text: str) -> str | None:
    """Pint's spelling of what labs write, None where it is not one of theirs. Turns count as turns, and 'Grad' is a
    degree wherever it stands (pint takes it for 10**9 radians, and 'grad' for 1/400 of a turn)."""
    bare = bare_unit(text)
    if found := _IN_THIS_CASE.get(bare) or UNIT_SPELLING.get(bare.casefold()):
        return found
    if words := in_words(bare):
        return words
    if _MICRO_INCH.fullmatch(bare):
        return "microinch"
    if turns := _TURNS_PER.fullmatch(bare):
        return f"{'kilo' if turns['kilo'] else ''}turn/{_time(turns['time'])}"
    if turns := _PER_TIME.fullmatch(bare) or _PER_TIME_RAISED.fullmatch(bare):
        return f"turn/{_time(turns['time'])}"
    if feed := _PER_TURN.fullmatch(bare):
        return f"{feed['length'].lower()}/turn"
    if rate := _RATE_A_MINUTE.fullmatch(bare):
        return f"{rate['what'].lower().replace('μ', 'u')}/min"
    if torque := _FOOT_POUND.fullmatch(bare):
        if torque["kilo"]:
            return f"kgf*{torque['metric'].lower()}"
        return f"force_pound*{'foot' if (torque['length'] or torque['behind']).lower() == 'ft' else 'inch'}"
    return _GRAD.sub("deg", bare) if _GRAD.search(bare) else None


def _time(written: str) -> str:
    known = {
        "s": "second",
        "sec": "second",
        "sek": "second",
        "秒": "second",
        "hr": "h",
        **dict.fromkeys(_MINUTES, "min"),
    }
    return known.get(written.lower(), written.lower())


def spellings() -> dict[str, tuple[str, ...]]:
    """Pint's spelling -> what labs write for it, in alphabetical order."""
    found: dict[str, list[str]] = {}
    for written, unit in (UNIT_SPELLING | _IN_THIS_CASE).items():
        found.setdefault(unit, []).append(written)
    return {unit: tuple(sorted(found[unit])) for unit in sorted(found, key=str.casefold)}
