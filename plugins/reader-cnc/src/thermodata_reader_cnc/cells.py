"""Single cells as values; None where a cell is none of its kind."""

from __future__ import annotations

import re

from thermodata_reader_cnc.columns import FALSE, TRUE

_FLOAT = re.compile(r"^[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?$|^[+-]?inf(?:inity)?$", re.IGNORECASE)
_GROUPED = {",": re.compile(r"^[+-]?\d{1,3}(?:[. ]\d{3})+,\d+$"), ".": re.compile(r"^[+-]?\d{1,3}(?:[, ]\d{3})+\.\d+$")}


def as_float(cell: str, decimal: str) -> float | None:
    """A number with this decimal mark, thousands in groups allowed ('1.234,5')."""
    if _GROUPED[decimal].match(cell):
        cell = cell.replace(" ", "").replace("." if decimal == "," else ",", "")
    if decimal == ",":
        if "." in cell:
            return None
        cell = cell.replace(",", ".")
    return float(cell) if _FLOAT.match(cell) else None


def as_int(cell: str) -> int | None:
    """A whole number that fits 64 bits."""
    if not re.fullmatch(r"[+-]?\d{1,19}", cell):
        return None
    value = int(cell)
    return value if -(2**63) <= value < 2**63 else None


def as_bool(cell: str) -> bool | None:
    """TRUE/FALSE in English or German."""
    return True if cell in TRUE else False if cell in FALSE else None
