"""What a file of settings beside a log without a header says of it, E1.ini of E1.txt: offered where the log is asked of
its period, and never taken."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from thermodata.reader.text.file.encoding import decode_head

_SUFFIXES = (".ini", ".cfg", ".INI", ".CFG")
_LARGEST, _SHOWN, _MOST = 20_000, 60, 40  # bytes; letters of a line; names
_LONGEST_KEY, _NO_KEY = 40, (";", "#", "[")
_UNIT = r"(?:[ _]?[\[(]?(?P<unit>ms|sec|s|min)[\])]?)?"
_PERIOD = re.compile(
    rf"(?i)(?:p[ée]riode?|periodo|interval(?:l|le|lo)?|messintervall|sample[ _]?(?:time|period|interval)|"
    rf"abtast(?:zeit|intervall)|dt|pas){_UNIT}"
)
_DAY = re.compile(r"(?i)date|datum|data|fecha|start[ _]?date|startdatum")
_CLOCK = re.compile(r"(?i)heure|time|uhrzeit|zeit|ora|hora|start[ _]?time|startzeit|start|beginn|d[ée]but")
_CHANNEL = re.compile(r"(?i)(?:voie|kanal|channel|chan|ch|canale|canal|spalte|column|colonne|signal)[ _]?(\d{1,3})")
_NUMBER = re.compile(r"(\d+(?:[.,]\d+)?)\s*(ms|sec|s|min)?")


def offered_by_ini(log: Path) -> str:
    """How the question of a period goes on; '' where no settings stand beside the log, or they say nothing of it."""
    path = next((p for p in map(log.with_suffix, _SUFFIXES) if p.is_file() and not p.is_symlink()), None)
    lines = {} if path is None else _lines(path)
    offers = [offer for offer in (_period(lines), _start(lines), _names(lines)) if offer]
    return f"; {path.name} says {'; '.join(offers)}" if path is not None and offers else ""


def _lines(path: Path) -> Mapping[str, str]:
    """key -> value, as written."""
    try:
        with path.open("rb") as file:
            data = file.read(_LARGEST + 1)
    except OSError:
        return {}
    text = (decode_head(data) or data.decode("cp1252", "replace")) if len(data) <= _LARGEST else ""
    parted = ([part.strip() for part in line.partition("=")] for line in text.splitlines())
    return {
        key: value
        for key, _, value in parted
        if key and value and len(key) <= _LONGEST_KEY and not key.startswith(_NO_KEY)
    }


def _quoted(lines: Mapping[str, str], key: str) -> str:
    return f"'{f'{key}={lines[key]}'[:_SHOWN]}'"


def _period(lines: Mapping[str, str]) -> str | None:
    for key, value in lines.items():
        named, number = _PERIOD.fullmatch(key), _NUMBER.fullmatch(value)
        unit = None if named is None or number is None else named["unit"] or number[2]
        if number is not None and unit:
            unit = "s" if unit.lower() == "sec" else unit.lower()
            return f"{_quoted(lines, key)}: period: {number[1].replace(',', '.')} {unit}?"
    return None


def _start(lines: Mapping[str, str]) -> str | None:
    day = next((k for k, v in lines.items() if _DAY.fullmatch(k) and re.search(r"\d", v)), None)
    clock = next((k for k, v in lines.items() if _CLOCK.fullmatch(k) and re.search(r"\d:\d\d", v)), None)
    said = [_quoted(lines, key) for key in (day, clock) if key is not None]
    return f"{' and '.join(said)}: the start of this test?" if said else None


def _names(lines: Mapping[str, str]) -> str | None:
    numbered = {int(m[1]): k for k in lines if (m := _CHANNEL.fullmatch(k)) is not None}
    if len(numbered) < 2 or sorted(numbered) != list(range(min(numbered), max(numbered) + 1)):
        return None
    names = ", ".join(f"'{lines[numbered[n]][:_SHOWN]}'" for n in sorted(numbered)[:_MOST])
    return f"{_quoted(lines, numbered[min(numbered)])}, ...: names: [{names}], beside time?"
