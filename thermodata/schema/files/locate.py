"""Where in a file stands what was refused once the file was read: what only the data, or the plugins, show is wrong."""

from __future__ import annotations

import re
from pathlib import Path

from thermodata.errors import ThermodataError
from thermodata.schema.agreed.effect_ids import ids_of
from thermodata.schema.strict.lines import Document, Place, at_place, dotted_place, read_document

_EXPRESSION = re.compile(r"expression '([^']+)'")
_EFFECT = re.compile(r"effect '([^']+)'")


def located(error: ThermodataError, path: Path) -> ThermodataError:
    """The same error with file and line in its `where`, if that begins with a place of the file, or the refused word
    (`got`) stands in the file once read; the error as it is where neither does, or it names a file already."""
    if path.name in (error.where or ""):
        return error
    by_place = placed(error, path)
    if by_place is not error or not error.got:
        return by_place
    try:
        document = read_document(path)
    except (ThermodataError, OSError):
        return error
    named = _EFFECT.search(error.where or "")
    of_text = _EXPRESSION.search(error.where or "")
    place = _place(document, of_text[1] if of_text else error.got.strip("'"), named)
    place = place or (_effect(document, named[1]) if named else None)
    if place is None:
        return error
    return error.at(document.where(place) + (f", {error.where}" if error.where else ""))


def placed(error: ThermodataError, path: Path) -> ThermodataError:
    """The same error with file and line, if its `where` begins with a place of the file, such as `calibrations.jump_z`:
    of the refused word (`got`) where that stands below it, as a value or a key; the error as it is where it doesn't."""
    dotted, comma, rest = (error.where or "").partition(", ")
    try:
        document = read_document(path)
    except (ThermodataError, OSError):
        return error
    place = next((p for p in document.line if p and dotted_place(p) == dotted), None)
    if place is None:
        return error
    word = (error.got or "").strip("'")
    below = [p for p in document.line if p[: len(place)] == place and p != place]
    refused = [p for p in below if _is_scalar(at_place(document.data, p)) and str(at_place(document.data, p)) == word]
    refused += [p for p in below if word in _keys(p[-1])]
    return error.at(document.where(next(iter(refused), place)) + comma + rest)


def _keys(key: str | int) -> list[str]:
    """'[D25, D63]' stands for both."""
    return [one.strip() for one in str(key).removeprefix("[").removesuffix("]").split(",")]


def _place(document: Document, word: str, effect: re.Match[str] | None) -> Place | None:
    """The first place that holds the word as its key or value, else within its text; in the named effect first."""
    places = [p for p in document.line if p]
    if effect is not None:
        own = [p for p in places if p[0] == "effects" and len(p) > 1 and _is_effect(document, p[:2], effect[1])]
        places = [*own, *(p for p in places if p not in set(own))]
    texts = {p: str(at_place(document.data, p)) for p in places if _is_scalar(at_place(document.data, p))}
    inside = re.compile(rf"(?<!\w){re.escape(word)}(?!\w)")
    return next(
        (
            place
            for fits in (lambda p: p[-1] == word or texts.get(p) == word, lambda p: inside.search(texts.get(p, "")))
            for place in places
            if fits(place)
        ),
        None,
    )


def _effect(document: Document, name: str) -> Place | None:
    """Where an effect stands, by its id in the answers."""
    effects = document.data.get("effects")
    if not isinstance(effects, list) or not all(isinstance(e, dict) for e in effects):
        return None
    ids = ids_of((str(e.get("effect")), e.get("id")) for e in effects)
    return ("effects", ids.index(name)) if name in ids else None


def _is_effect(document: Document, place: Place, name: str) -> bool:
    one = at_place(document.data, place)
    return isinstance(one, dict) and name in (one.get("id"), one.get("effect"))


def _is_scalar(value: object) -> bool:
    return not isinstance(value, dict | list)
