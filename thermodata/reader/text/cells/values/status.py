"""Quality and status of logged values: OPC's classic codes, of 8 bit or of 16 with a vendor's byte above, OPC UA's
status codes of 32 bit, and their words; and the severity of an alarm in EPICS, whose INVALID is no measured value."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any

from thermodata.errors import QuestionError
from thermodata.reader.text.cells.values.number import of_either_mark, to_bool
from thermodata.reader.times.open_questions import UNKNOWN, unanswered
from thermodata.schema.flag import Flag

BAD = int(Flag.NOT_MEASURING)
_HEX = re.compile(r"0[xX][0-9a-fA-F]+")
KEY = "quality_zero"  # of a table's layout
_ANSWERS = ("good", "bad")
_WHOSE = "(?:opc|ua|da|tag|data|value|sample|point|item|source)?"
_NAMES = tuple(
    re.compile(_WHOSE + pattern)
    for pattern in (
        "status(?:name|text)",
        "opc(?:da|ua)?(?:quality|status)(?:code)?|(?:quality|status)(?:opc|detail|details)",
        "(?:quality|qualit(?:ä|ae?)t|qualité|qualità|calidad|质量码|品質)(?:code|name|text|flags?)?",
        "statuscode",
        "status",
        "valid(?:ity)?",
        "dataintegrity",
    )
)
_GOOD_WORDS = ("good", "uncertain", "ok", "gut", "valid", "true", "no_alarm")
_BAD_WORDS = ("bad", "schlecht", "invalid", "false")
_SEVERITY = re.compile(r"(?i)(?:^|[ ._:/-])(?:alarm[ _]?)?(?:severity|sevr)(?:#\d+)?$")
_MEASURED = frozenset({"none", "no_alarm", "minor", "minor_alarm", "major", "major_alarm"})  # beyond a limit, perhaps
_SEVERITIES = _MEASURED | {"invalid", "invalid_alarm", "undefined", "disconnected"}
_FAULTS = re.compile(r"(?:err(?:or)?s?|fault|fehler|chyba)(?:code|flag|nr|no)?")
_MOST_FAULTS = 16  # different codes
_NO_FAULT = ("false", "ok", "none", "no", "no error", "good", "-", "nein", "kein", "keine", "falsch")
_INITIAL = 133  # the first value of Wonderware's answer, whose quality is 0 (good), 1 (bad), 16 (doubtful) or this
_GOOD = frozenset({0, 1, _INITIAL, *range(192, 220), 248, 249, 252})  # somewhere
_KNOWN = _GOOD | {*range(4, 33, 4), *range(64, 92, 4)}
_WORD = range(0x100, 0x10000)  # OPC's classic quality below a vendor's byte
# what its low byte keeps: uncertain, and good. Not all above 192, for 500 is a stale value in Ignition.
_KEPT = frozenset({*range(64, 96), *range(192, 220)})
_IGNITION, _IGNITION_GOOD = "dataintegrity", 192  # by its manual all else is bad


def _code(text: str) -> int | None:
    if text[:2].lower() == "0x":
        code = int(text, 16) if _HEX.fullmatch(text) else None
    else:
        number = None if to_bool(text) is not None else of_either_mark(text)
        code = None if number is None or not math.isfinite(number) else int(number)
    return code % 2**32 if code is not None and code < 0 else code  # a signed 32-bit status code


def tells_quality(name: str) -> int | None:
    """How surely a column is the quality of a value, by its bare name ("opcquality", "statuscode"): 0 the surest; None
    where it is none."""
    return next((k for k, pattern in enumerate(_NAMES) if pattern.fullmatch(name)), None)


def are_qualities(statuses: Iterable[str], name: str) -> bool:
    """Whether cells under a bare "Quality" are the codes or words of one, some of them good: no index or per cent, and
    no 0 and 1 of a machine that stands and runs under a bare "StatusCode", for no status of OPC UA is 1; and whether
    those under a "Severity" are words of EPICS, for other programs have severities of events."""
    if is_severity(name):
        said = {s.strip().casefold() for s in statuses} - {""}
        return bool(said & _MEASURED) and said <= _SEVERITIES
    none = frozenset({1}) if "status" in name.casefold() else frozenset()
    texts = {s.strip().casefold() for s in statuses} - {""}
    words = {text for text in texts if text.startswith((*_GOOD_WORDS, *_BAD_WORDS))}
    codes = {_code(text) for text in texts - words}
    known = all(c is not None and (c in _KNOWN - none or c > 255) for c in codes)
    low = {c & 0xFF for c in codes if c is not None and c in _WORD}
    good = codes & _GOOD or (low <= _KNOWN and low & _KEPT)
    return known and (bool(good) or any(is_good(word, True) for word in words))


def is_severity(name: str) -> bool:
    """Whether a column is called the severity of an alarm."""
    return _SEVERITY.search(name) is not None


def zero_is_good(statuses: Iterable[str], name: str) -> bool | None:
    """What the code 0 means: Good in OPC UA, whose codes have 32 bit, and in Wonderware; bad in OPC's classic quality
    (where 192 is good, of 16 bit its low byte) and where 1 means valid; None where the codes do not tell which, nor the
    name. statuses: sampled ones; name: the column's."""
    codes = {c for c in (_code(s.strip()) for s in statuses) if c is not None}
    if any(c > 0xFFFF for c in codes):
        return True
    classic = codes & {*range(64, 256)} - {_INITIAL} or {c & 0xFF for c in codes if c in _WORD} & _KEPT
    if classic or _is_ignition(name):
        return False
    if _INITIAL in codes:
        return True
    called_valid = "valid" in name.casefold()
    if {0, 1} <= codes:
        return False if called_valid else None
    may_be_classic = called_valid or "qual" in name.casefold()
    return None if may_be_classic and 0 in codes and codes <= {0, 16, *_WORD} else not may_be_classic and 1 not in codes


def _is_ignition(name: str) -> bool:
    return name.casefold().endswith(_IGNITION)


def declared_zero(table: Mapping[str, Any] | None, found: bool | None, name: str, where: str) -> bool:
    """Whether the code 0 is good: as the campaign file declares it, else as the codes tell. found: by `zero_is_good`.

    QuestionError where neither tells it.
    """
    said = (table or {}).get(KEY)
    if said in _ANSWERS:
        return bool(said == _ANSWERS[0])
    if found is not None:
        return found
    if said == UNKNOWN:
        raise unanswered(KEY, "good or bad", where)
    got = f"'{name}' says 0 of values that were looked at, and no code that tells"
    raise QuestionError(
        "a quality whose code 0 may mean good or bad",
        where=where,
        expected="codes that tell: 192 is good in OPC's classic quality, where 0 is bad; in OPC UA and Wonderware 0 is "
        "good",
        got=got,
        hint=f"declare table: {{{KEY}: good}}, or bad",
        ask=f"{KEY}: good or bad? {got}: good in OPC UA and Wonderware, bad in classic OPC and where 1 is valid",
        declare={KEY: UNKNOWN},
        meanwhile={KEY: _ANSWERS[0]},
    )


@lru_cache(maxsize=4096)
def is_good(status: str, zero: bool, name: str = "") -> bool:
    """Whether a status keeps its value: Good and Uncertain in words, OPC's 64...255, of 16 bit by their low byte, or
    UA's codes below bad; no status at all too; of a severity all but INVALID. zero: what the code 0 means; 1 means the
    other. name: the column's."""
    text = status.strip().casefold()
    if is_severity(name):
        return not text or text in _MEASURED
    if not text or text.startswith(_GOOD_WORDS):
        return True
    code = _code(text)
    if code is None:
        return False
    if _is_ignition(name):
        return code == _IGNITION_GOOD
    if code > 255:
        return code & 0xFF in _KEPT if code in _WORD else code >> 30 < 2
    if code == 0:
        return zero
    return code != 1 if zero else code == 1 or code >= 64


@lru_cache(maxsize=4096)
def is_no_fault(text: str) -> bool:
    """Whether a cell of a column of faults says none: 0, or a word for it; nothing at all too."""
    bare = text.strip().casefold()
    return not bare or bare in _NO_FAULT or _code(bare) == 0


def names_faults(name: str) -> bool:
    """Whether a column is called faults and no more, by its bare name."""
    return _FAULTS.fullmatch(name) is not None


def are_faults(cells: Iterable[str], name: str) -> bool:
    """Whether a column of long tables says the faults of its row, by its bare name ("errorcode"): none of most, and
    whole numbers or words, few of them; an error of a path is a length."""
    if not names_faults(name):
        return False
    codes = [code for code, _ in Counter(cell.strip() for cell in cells).most_common()]
    numbers = [to_bool(c) is None and of_either_mark(c) for c in codes]
    readings = any(n and (n < 0 or n % 1) for n in numbers)
    return 0 < len(codes) <= _MOST_FAULTS and is_no_fault(codes[0]) and not readings
