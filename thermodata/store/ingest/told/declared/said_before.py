"""What a campaign file says otherwise than the one that the store holds: a copy of an older one puts roles back."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from thermodata.schema.words.sentences import with_count

_NAMED = 6  # lines that are told
_SHORT = 40  # characters of a value that is told
_ABSENT = object()
_NOTHING: tuple[Any, ...] = (None, "", [], {}, False)


def said_before(before: Mapping[str, Any] | None, spec: str, path: Path) -> list[str]:
    """One note: 'the campaign file says otherwise than before: tests heat1: role verification, it was calibration; it
    stood in /old/campaign.yaml'. before: the row of the catalogue; spec: of the campaign file now, as JSON. None where
    nothing was held, or it says the same."""
    if before is None:
        return []
    lines = list(_changes(json.loads(before["spec"]), json.loads(spec)))
    if not lines:
        return []
    moved = "" if Path(before["path"]) == path else f"; that one stood at {before['path']}"
    return [f"the campaign file says otherwise than the one before: {with_count(lines, _NAMED)}{moved}"]


def _changes(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[str]:
    for key in dict.fromkeys([*before, *now]):
        was, given = _by_name(before.get(key)), _by_name(now.get(key))
        if _says_the_same(was, given):
            continue
        if not isinstance(was, Mapping) or not isinstance(given, Mapping):
            yield _change_in_words(key, was, given)
            continue
        for name in dict.fromkeys([*was, *given]):
            yield from _of_one(f"{key} {name}", was.get(name, _ABSENT), given.get(name, _ABSENT))


def _of_one(name: str, was: Any, now: Any) -> Iterator[str]:
    """Of a test, a channel: each of its words that is another one."""
    if was == now:
        return
    if now is _ABSENT or was is _ABSENT:
        if now is not _ABSENT or not name.startswith("tests "):  # which `taken_out` tells
            yield f"{name} is {'gone' if now is _ABSENT else 'new'}"
    elif isinstance(was, Mapping) and isinstance(now, Mapping):
        changed = [k for k in dict.fromkeys([*was, *now]) if not _says_the_same(was.get(k), now.get(k))]
        new = [k for k in changed if _short(was.get(k)) == "" and _short(now.get(k)) != ""]
        said = [_change_in_words(k, was.get(k), now.get(k)) for k in changed if k not in new]
        if new:
            said.append("new: " + ", ".join(f"{k} {_short(now[k]) or ''}".rstrip() for k in new))
        yield f"{name}: " + " and ".join(said)
    else:
        yield _change_in_words(name, was, now)


def _change_in_words(name: str, was: Any, now: Any) -> str:
    """'role verification, it was calibration'; what is long is named alone."""
    shown, earlier = (_short(value) for value in (now, was))
    if shown is None or earlier is None:
        return f"{name} is another one"
    return f"{name} {shown or 'is gone'}, it was {earlier}" if earlier else f"new: {name} {shown}"


def _short(value: Any) -> str | None:
    """'' of nothing; None of what is too long to be told."""
    if value is _ABSENT or not (value or value == 0):
        return ""
    text = value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= _SHORT else None


def _says_the_same(was: Any, now: Any) -> bool:
    """Whether both say the same; a word that came with a later version of this program, and says nothing, too."""
    return was == now or (was in _NOTHING and now in _NOTHING)


def _by_name(value: Any) -> Any:
    """Tests, which stand in a list, by their ids."""
    if isinstance(value, list) and value and all(isinstance(one, dict) and "id" in one for one in value):
        return {str(one["id"]): one for one in value}
    return value
