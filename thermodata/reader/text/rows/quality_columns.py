"""Quality columns of wide tables (`T1`, `T1.Quality`): rows that the source calls bad are flagged, values kept."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from thermodata.plugin import Array
from thermodata.reader.interleaved import bare_header
from thermodata.reader.text.cells.quotes import clean
from thermodata.reader.text.cells.status import BAD, are_qualities, is_good, tells_quality, zero_is_good

_WORD = (
    r"(?P<word>(?:tag|opc(?: ?[du]a)?)?[ _]?qualit(?:y|[äa]t)(?:[ _]?(?:code|details?|opc))?"
    r"|status[ _]?code|opc[ _]?status|validity)"
)
_QUALITY = re.compile(rf"^(?P<base>.+?)[ ._:/-]*{_WORD}$", re.IGNORECASE)
_BARE = re.compile(rf"^{_WORD}(?:#\d+)?$", re.IGNORECASE)  # a name that stands again has its number
_CODE = re.compile(r"^[+-]?\d*$")
_FRACTION = re.compile(r"^[+-]?\d*[.,]\d*[1-9]\d*$")  # no code: what is called the quality of oil, or of air
_ROUND = re.compile(r"^quality ?\((?P<base>.+)\)$", re.IGNORECASE)
_VALUE = re.compile(r"[ ._:/-]*(?:value|wert)$", re.IGNORECASE)
QUALITY_OF = "quality_of"  # property of a signal: the ones that it flags
_SHOWN = 4
Pairs = Mapping[str, tuple[str, bool]]
Told = Callable[[bool | None, str], bool | None]


def quality_pairs(
    columns: Mapping[str, Sequence[str]], told: Told = lambda zero, name: zero
) -> dict[str, tuple[str, bool]]:
    """Value column -> (its quality column, whether its code 0 is good). columns: name -> sampled cells; told: what the
    campaign file adds to what the codes of all columns of one word say (None: nothing)."""
    found = _of_bare(columns)
    for name in columns:
        match = _QUALITY.match(name) or _ROUND.match(name)
        if match is None or _BARE.match(name):
            continue
        base = match["base"].casefold()
        value = next((o for o in columns if o != name and _VALUE.sub("", o).casefold() == base), None)
        if value is not None and not any(_FRACTION.match(clean(cell)) for cell in columns[name]):
            found[value] = name, (match.groupdict().get("word") or "quality").casefold()
    zeros: dict[str, bool] = {}
    for _, word in found.values():
        if word not in zeros:
            own = [name for name, w in found.values() if w == word]
            zeros[word] = bool(told(zero_is_good((c for name in own for c in columns[name]), word), own[0]))
    return {value: (name, zeros[word]) for value, (name, word) in found.items()}


def may_be_quality(name: str) -> bool:
    """Whether a column is called a quality: the cells of others tell `quality_pairs` nothing."""
    return any(pattern.match(name) for pattern in (_QUALITY, _ROUND, _BARE))


def _of_bare(columns: Mapping[str, Sequence[str]]) -> dict[str, tuple[str, str]]:
    """Value column -> (a column that is called quality and no more, its word): of one such column all values of its
    row, of several each those that stand before it, or behind it where the first does."""
    matches = {name: match for name in columns if (match := _BARE.match(name))}
    bare = {n: m["word"].casefold() for n, m in matches.items() if are_qualities(map(clean, columns[n]), n)}
    if len(words := set(bare.values())) > 1:  # several of one row: the surest alone
        surest = min(words, key=lambda word: (tells_quality(bare_header(word)) or 0, word))
        bare = {name: word for name, word in bare.items() if word == surest}
    order = [name for name in columns if name in bare or not (_BARE.match(name) or _QUALITY.match(name))]
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


def shared(pairs: Pairs) -> list[str]:
    """A note on each quality column that flags the values of several others."""
    return [
        f"'{own}' is taken for the quality of all {len(values)} values of its row ({', '.join(values[:_SHOWN])}"
        f"{', ...' if len(values) > _SHOWN else ''}): where it is bad they do not count"
        for own, values in values_of(pairs).items()
        if len(values) > 1
    ]


def worded(columns: Mapping[str, Sequence[str]], pairs: Pairs) -> set[str]:
    """The quality columns that hold words or hexadecimal codes: text, however few these are."""
    told = {column for column, _ in pairs.values()}
    return {name for name in told if any(not _CODE.match(clean(cell)) for cell in columns[name])}


def bad_rows(values: Array, zero: bool) -> Array:
    """The flag of each row of a quality column, shape (n,), uint16: 0 where its value is kept as good."""
    if values.dtype.kind == "f":
        texts = np.where(np.isnan(values), "", np.char.mod("%d", np.nan_to_num(values)))
    else:
        texts = np.array(["" if v is None else str(v) for v in values.tolist()], str)
    words, which = np.unique(texts, return_inverse=True)
    flags: Array = np.array([0 if is_good(str(word), zero) else BAD for word in words], np.uint16)[which]
    return flags
