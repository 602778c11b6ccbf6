"""Units whose letters were read by another encoding than they were written in: 'řC' is '°C' in cp850."""

from __future__ import annotations

from thermodata.schema.units.unit import is_unit

_READ_AS = ("cp1250", "cp1252")  # what a text that is no UTF-8 is read as
_SIGNS = frozenset("°µμΩ²³·")
_WRITTEN_IN = ("cp850", "cp437", "cp852", "mac_roman")


def encoding_of(unit: str) -> tuple[str, str] | None:
    """(encoding, unit) in which the letters of what is no unit are one; None for a unit, and where none makes one."""
    if not _has_odd_letters(unit):
        return None
    for read_as in _READ_AS:
        for written_in in _WRITTEN_IN:
            try:
                found = unit.encode(read_as).decode(written_in)
            except UnicodeError:
                continue
            if not _has_odd_letters(found) and is_unit(found):
                return written_in, found
    return None


def _has_odd_letters(unit: str) -> bool:
    """Whether letters stand in it that units in plain letters don't have."""
    return any(not c.isascii() and c not in _SIGNS for c in unit)


def encoding_hint(unit: str) -> str:
    """'encoding: cp850 in the source, for 'řC' is '°C' there; or ', to stand before what else may be tried; '' where no
    encoding makes it a unit."""
    found = encoding_of(unit)
    return "" if found is None else f"encoding: {found[0]} in the source, by which '{unit}' is '{found[1]}'; or "


def mended(text: str) -> str | None:
    """A text in UTF-8 that was read as one of Windows, and saved so: 'µm' of 'Âµm', 'Bâti' of 'BÃ¢ti'. None where it is
    none."""
    for wrong in ("cp1252", "latin-1"):
        try:
            right = text.encode(wrong).decode("utf-8")
        except UnicodeError:
            continue
        return right if right != text else None
    return None
