"""Quality columns of wide tables (`T1`, `T1.Quality`): rows that the source calls bad are flagged, values kept."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Literal

import numpy as np

from thermodata.plugin import Array
from thermodata.reader.signals.header_words import VALUE_WORDS
from thermodata.reader.signals.interleaved import bare_header
from thermodata.reader.text.cells.values.number import of_either_mark, to_bool
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.cells.values.status import (
    BAD,
    are_faults,
    are_qualities,
    is_good,
    is_no_fault,
    is_severity,
    names_faults,
    tells_quality,
    zero_is_good,
)
from thermodata.reader.text.names.header import split_unit

_WORD = (
    r"(?P<word>(?:tag|opc(?: ?[du]a)?)?[ _]?qualit(?:y|[äa]t)(?:[ _]?(?:code|details?|opc))?"
    r"|status[ _]?code|opc[ _]?status|valid(?:ity)?|(?:alarm[ _]?)?(?:severity|sevr))"
)
_QUALITY = re.compile(rf"^(?P<base>.+?)[ ._:/-]*{_WORD}$", re.IGNORECASE)
_BARE = re.compile(rf"^{_WORD}(?:#\d+)?$", re.IGNORECASE)  # a name that stands again has its number
# what a logger writes beside a channel: its faults, of which 0 is none, or a state in codes of its own
_BESIDE = re.compile(
    r"^(?P<base>.+?)[ ._:/-]+(?:(?P<fault>err(?:or)?s?|fault|fehler|chyba)(?:[ _]?(?:code|flag|nr|no))?"
    r"|(?P<state>status|state|zustand|stav|estado|état))$",
    re.IGNORECASE,
)
_STATUS = re.compile(r"status$", re.IGNORECASE)
_SWITCH = frozenset({"0", "1", "true", "false", "on", "off", "ein", "aus", "yes", "no", "ja", "nein"})
_MOST_CODES = 16
_CODE = re.compile(r"^[+-]?\d*$")
_FRACTION = re.compile(r"^[+-]?\d*[.,]\d*[1-9]\d*$")  # no code: what is called the quality of oil, or of air
_ROUND = re.compile(r"^quality ?\((?P<base>.+)\)$", re.IGNORECASE)
_WHOLE = re.compile(r"^\+?\d+(?:[.,]0*)?$")
_VALUE = re.compile(r"[ ._:/-]*(?:value|wert)$", re.IGNORECASE)
QUALITY_OF = "quality_of"  # property of a signal: the ones that it flags
STATE_OF = "state_of"  # and the one whose state it tells, in codes that are not known here
SHOWN = 4  # names of columns, or codes, in a note
Pairs = Mapping[str, tuple[str, bool]]
Told = Callable[[bool | None, str], bool | None]


def quality_pairs(
    columns: Mapping[str, Sequence[str]], told: Told = lambda zero, name: zero, measured: Collection[str] = ()
) -> dict[str, tuple[str, bool]]:
    """Value column -> (its quality column, whether its code 0 is good). columns: name -> sampled cells; told: what the
    campaign file adds to what the codes of all columns of one word say (None: nothing); measured: those with a unit."""
    found = _of_bare(columns)
    for name in columns:
        match = _QUALITY.match(name) or _ROUND.match(name)
        if match is None or _BARE.match(name) or (is_severity(name) and not _are_qualities(columns, name)):
            continue
        value = _value(columns, name, match["base"])
        if value is not None and not any(_FRACTION.match(clean(cell)) for cell in columns[name]):
            found[value] = name, (match.groupdict().get("word") or "quality").casefold()
    pairs = _with_zeros(found, columns, told)
    for value, name in {**_columns_of_codes(columns, "fault", measured), **_faults_of_row(columns)}.items():
        pairs.setdefault(value, (name, True))
    for value, name in _columns_of_codes(columns, "state", measured).items():
        if not _is_a_switch(columns[name]) and _are_qualities(columns, name):
            pairs.setdefault(value, (name, True))
    return pairs


def second_pairs(
    columns: Mapping[str, Sequence[str]], pairs: Pairs, told: Told, measured: Collection[str]
) -> dict[str, tuple[str, bool]]:
    """The same of values that have a quality in `pairs`, and their faults, or a quality of the whole row, too."""
    beside = {**_columns_of_codes(columns, "fault", measured), **_faults_of_row(columns)}
    faults = {value: (name, True) for value, name in beside.items()}
    found = _with_zeros(_of_bare(columns), columns, told) | faults
    return {value: own for value, own in found.items() if pairs[value] != own}


def states(columns: Mapping[str, Sequence[str]], pairs: Pairs, measured: Collection[str] = ()) -> dict[str, str]:
    """Column of a state in codes that are not known here -> the value that it stands beside."""
    known = {own for own, _ in pairs.values()}
    return {name: value for value, name in _columns_of_codes(columns, "state", measured).items() if name not in known}


def said_of_codes(columns: Mapping[str, Sequence[str]], found: Mapping[str, str], *pairs: Pairs) -> list[str]:
    """A note on each column of faults, and of a status whose codes are not known. found: by `states`."""
    faults = {own: value for each in pairs for value, (own, _) in each.items() if tells_faults(own)}
    noted = [
        f"'{own}' tells the faults of '{value}': rows on which it is not 0 do not count"
        for own, value in faults.items()
    ]
    return noted + [
        f"'{name}' holds codes of '{value}' ({', '.join(_codes(columns[name])[:SHOWN])}) that are not known here: its "
        "rows count whatever they say; leave those out by the test's measuring, with it as a channel of quantity state"
        for name, value in found.items()
        if _STATUS.search(name) and not _is_a_switch(columns[name])
    ]


def _are_qualities(columns: Mapping[str, Sequence[str]], name: str) -> bool:
    return are_qualities(map(clean, columns[name]), name)


def _is_a_switch(cells: Sequence[str]) -> bool:
    """Whether the codes of a state are on and off: that something runs is no fault of it."""
    codes = {code.casefold() for code in _codes(cells)}
    return codes <= _SWITCH and codes != {"0"}


def tells_faults(name: str) -> bool:
    """Whether a column says the faults of another: 0 is none, and all else one."""
    match = _BESIDE.match(name)
    return names_faults(bare_header(name)) if match is None else match["fault"] is not None


def _columns_of_codes(
    columns: Mapping[str, Sequence[str]], sort: Literal["fault", "state"], measured: Collection[str]
) -> dict[str, str]:
    """Value column -> the one of its faults, or of its states, which holds a few codes; where faults are, 0 mostly."""
    found: dict[str, str] = {}
    for name, cells in columns.items():
        match = None if name in measured else _BESIDE.match(name)
        if match is None or match[sort] is None:
            continue
        value = _value(columns, name, match["base"])
        if value is None or not 0 < len(codes := _codes(cells)) <= _MOST_CODES:
            continue
        numbers = all(_WHOLE.match(code) for code in codes)
        if match["fault"] and not (is_no_fault(codes[0]) and (numbers or not any(map(_is_a_reading, codes)))):
            continue  # what is called an error of a path is a length
        if numbers or (match["fault"] is None and are_qualities(codes, name)) or match["fault"]:
            found[value] = name
    return found


def _faults_of_row(columns: Mapping[str, Sequence[str]]) -> dict[str, str]:
    """The one column of a long table that is called a value -> the one that is called its fault and no more."""
    values = [name for name in columns if bare_header(name) in VALUE_WORDS]
    faults = [name for name, cells in columns.items() if are_faults(map(clean, cells), bare_header(name))]
    return {values[0]: faults[0]} if len(values) == 1 and len(faults) == 1 else {}


def _codes(cells: Sequence[str]) -> list[str]:
    """The different cells that hold something, the most frequent first."""
    return [code for code, _ in Counter(filter(None, map(clean, cells))).most_common()]


def _is_a_reading(text: str) -> bool:
    """Whether a cell holds a fraction, or a number below 0."""
    number = None if to_bool(text) is not None else of_either_mark(text)
    return number is not None and not _WHOLE.match(text)


def _value(columns: Mapping[str, Sequence[str]], name: str, base: str) -> str | None:
    """The column of values that another one is called after, with its unit or without."""
    called, own = base.casefold(), split_unit(base)[0].casefold()

    def matches(other: str) -> bool:
        bare = _VALUE.sub("", split_unit(other)[0]).casefold()
        return other != name and (bare == own or _VALUE.sub("", other).casefold() == called)

    return next(filter(matches, columns), None)


def _with_zeros(
    found: Mapping[str, tuple[str, str]], columns: Mapping[str, Sequence[str]], told: Told
) -> dict[str, tuple[str, bool]]:
    zeros: dict[str, bool] = {}
    for _, word in found.values():
        if word not in zeros:
            own = [name for name, w in found.values() if w == word]
            zeros[word] = bool(told(zero_is_good((c for name in own for c in columns[name]), word), own[0]))
    return {value: (name, zeros[word]) for value, (name, word) in found.items()}


def may_be_quality(name: str) -> bool:
    """Whether a column is called a quality: the cells of others tell `quality_pairs` nothing."""
    return any(pattern.match(name) for pattern in (_QUALITY, _ROUND, _BARE, _BESIDE))


def _of_bare(columns: Mapping[str, Sequence[str]]) -> dict[str, tuple[str, str]]:
    """Value column -> (a column that is called quality and no more, its word): of one such column all values of its
    row, of several each those that stand before it, or behind it where the first does."""
    matches = {name: match for name in columns if (match := _BARE.match(name))}
    bare = {n: m["word"].casefold() for n, m in matches.items() if _are_qualities(columns, n)}
    if len(words := set(bare.values())) > 1:  # several of one row: the surest alone
        surest = min(words, key=lambda word: (is_severity(word), tells_quality(bare_header(word)) or 0, word))
        bare = {name: word for name, word in bare.items() if word == surest}
    beside = {*_columns_of_codes(columns, "fault", ()).values(), *_columns_of_codes(columns, "state", ()).values()}
    order = [
        name for name in columns if name in bare or not (name in beside or _BARE.match(name) or _QUALITY.match(name))
    ]
    if len(bare) > 1 and order[-1] in bare:
        order.reverse()
    own = next(iter(bare), None) if len(bare) == 1 else None
    found: dict[str, tuple[str, str]] = {}
    for name in order:
        if name in bare:
            own = name
        elif own is not None:
            found[name] = own, bare[own]
    return found


def values_of(pairs: Pairs) -> dict[str, list[str]]:
    """The values of each quality column, by it."""
    values: dict[str, list[str]] = {}
    for value, (own, _) in pairs.items():
        values.setdefault(own, []).append(value)
    return values


def worded(columns: Mapping[str, Sequence[str]], pairs: Pairs) -> set[str]:
    """The quality columns that hold words or hexadecimal codes: text, however few these are."""
    told = {column for column, _ in pairs.values()}
    return {name for name in told if any(not _CODE.match(clean(cell)) for cell in columns[name])}


def bad_rows(values: Array, zero: bool, name: str = "") -> Array:
    """The flag of each row of a quality column, shape (n,), uint16: 0 where its value is kept as good. name: the
    column's, which tells whether it says faults, of which 0 is none, or the severity of alarms."""
    if values.dtype.kind == "f":
        texts = np.where(np.isnan(values), "", np.char.mod("%d", np.nan_to_num(values)))
    else:
        texts = np.array(["" if v is None else str(v) for v in values.tolist()], str)
    words, which = np.unique(texts, return_inverse=True)
    flags: Array = np.array([0 if _keeps(str(word), zero, name) else BAD for word in words], np.uint16)[which]
    return flags


def _keeps(text: str, zero: bool, name: str) -> bool:
    return is_no_fault(text) if tells_faults(name) else is_good(text, zero, name)
