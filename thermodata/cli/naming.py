"""What a signal's name and unit suggest, in English, German and Czech. Guesses for a draft; a person decides."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

from thermodata.errors import UsageError
from thermodata.schema.campaign import RESERVED_NAMES
from thermodata.schema.quantity import CANONICAL_UNIT, linear_conversion, normal_unit

# Quantity -> words in its names (stems: diacritics and case are gone before matching).
_WORDS: tuple[tuple[str, str], ...] = (
    ("rotational_speed", r"\b(n ?act|n ?ist|speed|rpm|drehzahl|otack\w*|otac\w*|spindle speed|s act)\b"),
    ("feed", r"\b(feed|f act|vorschub\w*|posuv\w*|v act)\b"),
    ("power", r"\b(power|leistung\w*|vykon\w*|wirkleistung)\b"),
    ("load", r"\b(load|auslastung\w*|last|zatizeni|vytizeni)\b"),
    ("torque", r"\b(torque|drehmoment|kroutici|moment)\b"),
    ("current", r"\b(current|strom|proud|i act)\b"),
    ("position", r"\b(pos|position|poloha|lage|istposition)\b"),
    ("flow", r"\b(flow|durchfluss|prutok)\b"),
    ("pressure", r"\b(pressure|druck|tlak)\b"),
    ("humidity", r"\b(humidity|feuchte|luftfeuchte|vlhkost|rh)\b"),
    ("irradiance", r"\b(sun|irradiance|sonne|slunce|zareni)\b"),
    ("state", r"\b(door|tur|dvere|on|ein|zap|flag|active|aktiv|state|status|zustand|stav|coolant on|b door)\b"),
    ("displacement", r"\b(eddy|probe|disp\w*|verlagerung\w*|verschiebung\w*|posunuti|vychylka|deformace|wirbelstrom|"
                     r"taster|snimac|lvdt|gap|d [xyz]|d[xyz]\d?)\b"),
    ("temperature", r"\b(t|t\d+|temp\w*|teplota|tepl|pt ?100\w*|thermo\w*|rtd\w*)\b"),
)
_BY_UNIT: dict[str, str] = {
    "degC": "temperature", "degF": "temperature", "um": "displacement", "rpm": "rotational_speed",
    "m/min": "feed", "mm/min": "feed", "kW": "power", "W": "power", "A": "current", "mA": "current", "N*m": "torque",
    "mm": "position", "l/min": "flow", "bar": "pressure", "W/m**2": "irradiance", "urad": "tilt", "deg": "angle",
    "K": "temperature_difference", "ohm": "resistance",
}
_BEARING = r"\b(bearing|lager|lozisk\w*|brg)\b"
_SPINDLE, _MOTOR = r"\b(spindle|spindel|vreten\w*|sp\d?)\b", r"\bmotor\w*\b"
_COLUMN = r"\b(column|stander|saule|stojan|sloup)\b"
_HALL = r"\b(hall|hala|halle|amb\w*|umgebung|okoli|air|luft|vzduch)\b"
_FRONT, _REAR = r"\b(front|vorn\w*|predni|f|a side)\b", r"\b(rear|back|hinten|hinter\w*|zadni|r|b side)\b"


def _both(one: str, other: str) -> str:
    """A pattern that finds both words, in any order."""
    return rf"(?=.*{one})(?=.*{other})"


# Place -> words; {a} stands for an axis letter found in the name. The first that fits wins.
_PLACES: tuple[tuple[str, str], ...] = (
    ("axis.{a}.nut", r"\b(nut|mutter|matice)\b"),
    ("axis.{a}.screw", r"\b(screw|gewindetrieb|kgt|sroub)\b"),
    ("axis.{a}.scale", r"\b(scale|massstab|pravitko)\b"),
    ("spindle.bearing.front", _both(_BEARING, _FRONT)),
    ("spindle.bearing.rear", _both(_BEARING, _REAR)),
    ("table.bearing", _both(r"\b(table|tisch|stul|stol)\b", _BEARING)),
    ("spindle.bearing.front", _BEARING),
    ("spindle.motor", _both(_SPINDLE, _MOTOR)),
    ("axis.{a}.motor", _MOTOR),
    ("headstock", r"\b(headstock|spindelstock|spindelkasten|vretenik\w*)\b"),
    ("coolant.return", r"\b(coolant|kuhlmittel|kss|chlad\w*)\b.*\b(return|rucklauf|zpatecka|out)\b"),
    ("coolant.supply", r"\b(coolant|kuhlmittel|kss|chlad\w*|emulze)\b"),
    ("hydraulics", r"\bhydraul\w*\b"), ("cabinet", r"\b(cabinet|schaltschrank|rozvadec\w*)\b"),
    ("column.rear", _both(_COLUMN, _REAR)),
    ("column.left", _both(_COLUMN, r"\b(left|links|levy|l)\b")),
    ("column.right", _both(_COLUMN, r"\b(right|rechts|pravy)\b")),
    ("column.front", _COLUMN),
    ("hall.door", r"\b(door|tur|tor|dvere|vrata)\b"),
    ("hall.top", _both(_HALL, r"\b(top|oben|nahore|up\w*)\b")),
    ("hall.bottom", _HALL),
    ("floor", r"\b(floor|boden|fundament|podlaha|zaklad)\b"), ("bed", r"\b(bed|bett|loze|maschinenbett)\b"),
    ("ram", r"\b(ram|pinole|smykadlo)\b"), ("tool", r"\b(tool|werkzeug|nastroj)\b"),
    ("workpiece", r"\b(workpiece|werkstuck|obrobek)\b"), ("fixture", r"\b(fixture|vorrichtung|pripravek)\b"),
    ("table", r"\b(table|tisch|stul|stol)\b"), ("spindle", _SPINDLE),
)


_WITHOUT_UNIT = frozenset({"label", "state", "tilt", "angle"})        # pint converts any bare number to these
_NAME_KNOWS_BETTER = {("position", "displacement"), ("temperature_difference", "temperature")}


@dataclass(frozen=True, slots=True)
class Guess:
    """quantity (None: there is none for the unit) and unit as they would stand in a campaign file; doubts: what a
    person should look at."""

    quantity: str | None
    unit: str | None
    at: str | None
    axis: str | None
    doubts: tuple[str, ...]


def words(name: str) -> str:
    """'Eddy/nActSpeed_Z' -> 'eddy n act speed z': no case, no diacritics, camel humps and digits apart."""
    bare = unicodedata.normalize("NFKD", name.replace("ß", "ss"))
    bare = "".join(c for c in bare if not unicodedata.combining(c))
    bare = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", bare)
    return " ".join(re.split(r"[^A-Za-z0-9]+", bare)).strip().lower()


def guess(name: str, unit: str | None, dtype: str = "float64") -> Guess:
    """Quantity, place and axis of a signal; what is not sure is said in `doubts`."""
    text, doubts = words(name), []
    normal = normal_unit(unit) if unit else None
    by_name = next((quantity for quantity, pattern in _WORDS if re.search(pattern, text)), None)
    by_unit = _BY_UNIT.get(normal) if normal else None
    quantity: str | None
    if dtype == "str":
        quantity = "label"
    elif dtype == "bool" or (by_name == "state" and by_unit is None):
        quantity = "state"
    elif normal in ("V", "mV"):
        # only probes are commonly logged in volts; anything else in volts needs a calibration first
        quantity = "displacement" if by_name == "displacement" else "voltage"
        if quantity == "voltage":
            doubts.append("what does it measure? then: calibration")
    elif by_unit and (by_unit, by_name) not in _NAME_KNOWS_BETTER:
        quantity = by_unit
    elif by_name and (normal is None or _converts(normal, by_name)):
        quantity = by_name
    elif normal in (None, "dimensionless"):
        quantity = "state" if normal or dtype.startswith(("int", "uint")) else "voltage"
        doubts.append("quantity?")
    else:
        quantity = next((q for q in CANONICAL_UNIT if q not in _WITHOUT_UNIT and _converts(normal, q)), None)
        doubts.append("quantity?" if quantity else f"no quantity has the unit {unit}")
    if quantity is None:
        return Guess(None, unit, None, None, tuple(doubts))
    letter = re.search(r"(?:^|\s)(?:[a-z]{0,4}\s)?([xyzabc])\d?(?:\s|$)|\b(?:d|pos|feed|nut|ax)([xyzabc])\b", text)
    axis = (letter[1] or letter[2]) if letter else None
    place = next((place for place, pattern in _PLACES if re.search(pattern, text)), None)
    if place and "{a}" in place:
        place = place.format(a=axis) if axis else None
    if quantity in ("position", "feed") and axis and place is None:
        place = f"axis.{axis}"
    if quantity == "rotational_speed" and place is None:
        place = "spindle"
    if quantity == "displacement":
        place = "tcp"
        if axis is None:
            doubts.append("axis?")
    elif place is None and quantity in ("temperature", "temperature_difference", "power", "load", "current"):
        doubts.append("at: where on the machine?")
    if unit is None and quantity not in ("state", "label"):
        unit = "V" if quantity == "displacement" else CANONICAL_UNIT[quantity]
        doubts.append("unit?")
    return Guess(quantity, None if quantity in ("state", "label") else unit, place,
                 axis.upper() if axis and quantity in ("displacement", "tilt") else None, tuple(doubts))


def _converts(unit: str, quantity: str) -> bool:
    try:
        linear_conversion(unit, CANONICAL_UNIT[quantity])
    except UsageError:
        return False
    return True


def channel_name(signal: str, taken: set[str]) -> str:
    """A channel name from a signal's: its last part, plain letters, unique ignoring case; added to `taken`."""
    plain = unicodedata.normalize("NFKD", signal.replace("ß", "ss"))
    plain = "".join(c for c in plain if not unicodedata.combining(c))
    parts = [p for p in re.split(r"[/.]", re.sub(r"[\[(][^\])]*[\])]\s*$", "", plain)) if p.strip()]
    last = re.sub(r"[^A-Za-z0-9]+", "_", parts[-1] if parts else plain).strip("_") or "channel"
    if len(last) == 1 and len(parts) > 1:                    # Eddy/Z says more than Z
        last = re.sub(r"[^A-Za-z0-9]+", "_", "_".join(parts[-2:])).strip("_")
    last = last if last[0].isalpha() else f"ch_{last}"
    name, n = last, 1
    while name.lower() in taken or name.lower() in RESERVED_NAMES:
        n += 1
        name = f"{last}_{n}"
    taken.add(name.lower())
    return name
