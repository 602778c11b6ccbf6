"""The signal that a campaign file means: the name in the file, with what may be left out."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Sequence
from difflib import get_close_matches

from thermodata.errors import UsageError
from thermodata.plugin import Signal
from thermodata.reader.signals.by_place import BY_PLACE
from thermodata.reader.text import split_unit
from thermodata.schema.words.sentences import with_count


class NoSignalError(UsageError):
    """A name that no signal of the file has, nor one that is meant by it."""


def _without_unit(name: str) -> str:
    return split_unit(name)[0]


def _last_part(name: str) -> str:
    return name.rsplit("/", 1)[-1]


_SPELLINGS: tuple[Callable[[str], str], ...] = (
    lambda name: name,
    _without_unit,
    _last_part,
    lambda name: _without_unit(_last_part(name)),
)


_WHERE: tuple[Callable[[str], str], ...] = (str, _last_part)
_COUNTED = re.compile(r"\s+\[(\d+)\]$")


def _without_one(wanted: str, signals: Sequence[Signal]) -> Signal | None:
    """The signal whose unit is written as 1: 'bCoolant [1]'. None where another is counted so: 1 and 2 of 'T [1]' and
    'T [2]' are no units."""
    found = [
        s for s in signals if wanted.casefold() in (spell(_COUNTED.sub("", s.name)).casefold() for spell in _WHERE)
    ]
    number = _COUNTED.search(found[0].name) if len(found) == 1 else None
    return found[0] if number is not None and number[1] == "1" else None


def match_signal(wanted: str, signals: Sequence[Signal]) -> Signal:
    """The one signal that `wanted` names: exactly, then by its place (`BY_PLACE`), then without the unit in brackets,
    then by the part after the last '/'; each first with case, then without; last without a unit that is 1. A stream may
    be named before it: 'Eddy@2:Eddy/Z'.

    UsageError: no such signal (with the nearest names), or several that the same spelling fits.
    """
    for exact in (
        [s for s in signals if s.name == wanted],
        [s for s in signals if s.properties.get(BY_PLACE) == wanted],
    ):
        if len(exact) == 1:
            return exact[0]
    for fold in (str, str.casefold):
        for spell in _SPELLINGS:
            found = [s for s in signals if fold(spell(s.name)) == fold(wanted)]
            found = found or [s for s in signals if fold(f"{s.stream}:{spell(s.name)}") == fold(wanted)]
            if len(found) == 1:
                return found[0]
            if found:
                names = ", ".join(f"{s.stream}:{s.name}" for s in found)
                raise UsageError(
                    f"signal '{wanted}' is ambiguous",
                    expected="one signal",
                    got=names,
                    hint=_told_apart(wanted, found, signals),
                )
    if (one := _without_one(wanted, signals)) is not None:
        return one
    names_by_fold = {spell(s.name).casefold(): s.name for s in signals for spell in reversed(_SPELLINGS)}
    close = list(dict.fromkeys(names_by_fold[c] for c in get_close_matches(wanted.casefold(), names_by_fold, 3, 0.5)))
    listed = [s.name for s in signals[:20]] + (["..."] if len(signals) > 20 else [])
    raise NoSignalError(
        f"no signal '{wanted}' in the file",
        expected=", ".join(close or listed) or "the file has none",
        got=wanted,
        hint=_by_name_now(wanted, signals)
        or _other_encoding(wanted, close)
        or (f"did you mean '{close[0]}'?" if close else None),
    )


def _told_apart(wanted: str, found: Sequence[Signal], signals: Sequence[Signal]) -> str:
    """How to write each of several signals, so that it is meant alone."""
    names = Counter(s.name for s in signals)
    ways = (s.name if names[s.name] == 1 else f"{s.stream}:{s.name}" for s in found)
    return "write " + " or ".join(f"'{way}'" for way in dict.fromkeys(ways) if way != wanted)


def _by_name_now(wanted: str, signals: Sequence[Signal]) -> str | None:
    """Which of several names an element has that is asked for by its place cannot be told where the places change."""
    array, _, rest = wanted.partition("[")
    named = [s.name for s in signals if s.name.startswith(f"{array}.")]
    if not rest[:1].isdigit() or not named:
        return None
    return f"the elements of '{array}' change their places, and go by their names: {with_count(named, 8)}"


def _other_encoding(wanted: str, close: Sequence[str]) -> str | None:
    """What to declare where a name of the file is the wanted one in another encoding: 'Pičce' is 'Pièce' in cp1252."""
    for name in close:
        for read, meant in (("cp1250", "cp1252"), ("cp1252", "cp1250")):
            try:
                other = name.encode(read).decode(meant)
            except UnicodeError:
                continue
            if other != name and wanted.casefold() in (spell(other).casefold() for spell in _SPELLINGS):
                return f"declare 'encoding: {meant}' for the source: '{name}' is '{other}' then"
    return None
