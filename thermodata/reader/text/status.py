"""Quality and status of logged values: OPC's classic codes, OPC UA's status codes, and their words."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from functools import lru_cache

from thermodata.reader.text.number import to_bool, to_float
from thermodata.schema.flag import Flag

BAD = int(Flag.NOT_MEASURING)
_HEX = re.compile(r"0[xX][0-9a-fA-F]+")
_GOOD_WORDS = ("good", "uncertain", "ok", "gut", "valid", "true")


def _code(text: str) -> int | None:
    if text[:2].lower() == "0x":
        code = int(text, 16) if _HEX.fullmatch(text) else None
    else:
        number = None if to_bool(text) is not None else to_float(text, "," if "," in text else ".")
        code = None if number is None or not math.isfinite(number) else int(number)
    return code % 2**32 if code is not None and code < 0 else code  # a signed 32-bit status code


def zero_is_good(statuses: Iterable[str], name: str) -> bool:
    """What the code 0 means: OPC UA's Good, or bad in OPC's classic quality (where 192 is good) and where 1 means
    valid. statuses: sampled ones; name: the column's, which decides where they are all 0."""
    codes = {c for c in (_code(s.strip()) for s in statuses) if c is not None}
    if any(c > 255 for c in codes):
        return True
    if codes & {1, *range(64, 256)}:
        return False
    return "qual" not in name.casefold() and "valid" not in name.casefold()


@lru_cache(maxsize=4096)
def is_good(status: str, zero: bool) -> bool:
    """Whether a status keeps its value: Good and Uncertain in words, OPC's 64...255, or UA's codes below bad; no
    status at all too. zero: what the code 0 means."""
    text = status.strip().casefold()
    if not text or text.startswith(_GOOD_WORDS):
        return True
    code = _code(text)
    if code is None:
        return False
    if code == 0:
        return zero
    if zero:
        return code >> 30 < 2
    return code == 1 or 64 <= code <= 255 or (code > 255 and code >> 30 < 2)
