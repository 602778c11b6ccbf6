"""Words by which files state a factor, an offset or a turned sign, and of which signal they do: 'dZ_gain' of dZ."""

from __future__ import annotations

import re

from thermodata.reader.text.names.header import looks_like_unit, split_unit

_FACTOR = (
    r"fa[kc]tors?|faktoren|scal(?:e|ing)(?:[ _-]?(?:factor|gain))?|skalierung(?:sfaktor)?|gains?|multiplier|"
    r"multipli[kc]ator|slope|verstärkung|facteur|fattore|násobek|měřítko|steigung|1 (?:digit|count|lsb|bit|inkrement)|"
    r"(?:cal(?:ib(?:ration)?)?|conv(?:ersion)?|kalibrier|umrechnungs)[ _-]?fa[kc]tor"
)
_OFFSET = r"(?:(?:add|scale)[_ ])?offsets?|nullpunkt|zero|intercept|achsenabschnitt"
_TURNED = r"polarity|polarität|sign|vorzeichen|invert(?:ed)?"
FACTOR = re.compile(_FACTOR, re.IGNORECASE)
OFFSET = re.compile(_OFFSET, re.IGNORECASE)
TURNED = re.compile(_TURNED, re.IGNORECASE)
_ANY = f"(?P<word>{_FACTOR}|{_OFFSET}|{_TURNED})"
_WORD = re.compile(_ANY, re.IGNORECASE)
_BEHIND = re.compile(rf"(?P<name>.+?)(?:[ _.:-]+|(?-i:(?<=[a-zA-Z0-9])(?=[A-Z]))){_ANY}", re.IGNORECASE)
_BEFORE = re.compile(rf"{_ANY}[ _.:-]+(?P<name>.+)", re.IGNORECASE)


def states_scale(key: str) -> bool:
    """Whether a property is called as a factor, an offset or a turned sign is, without a signal: 'Gain'."""
    return _WORD.fullmatch(key) is not None


def stated_of(key: str) -> tuple[str, str] | None:
    """(signal, word): ('dZ', 'gain') of 'dZ_gain', 'gain_dZ', 'dZGain', 'cal/dZ/gain' and 'gain/dZ'; None of a key that
    states no scale, or of no signal by its name."""
    *above, last = key.split("/")
    if states_scale(last):
        return (above[-1], last) if above else None
    if above and states_scale(above[-1]):
        return last, above[-1]
    found = _BEHIND.fullmatch(last) or _BEFORE.fullmatch(last)
    return None if found is None else (found["name"], found["word"])


def is_called(signal: str, name: str) -> bool:
    """Whether a signal goes by a name: 'Log/dZ_um' by 'dZ', whatever its groups and its unit are."""
    return name.casefold() in spellings(signal)


def spellings(signal: str) -> tuple[str, ...]:
    """What a signal may be called where something is said of it, in small letters, each once."""
    bare = split_unit(signal)[0]
    names = list[str]()
    for name in (signal, bare, re.split(r"[/\\]", bare)[-1], re.split(r"[/\\.]", bare)[-1]):
        before, _, end = name.rpartition("_")
        names += (name, before) if before and looks_like_unit(end) else (name,)
    return tuple(dict.fromkeys(name.casefold() for name in names))
