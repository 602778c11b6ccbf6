"""What a text says of a name in one line, where several begin with it: a sentence on the probe above the list of the
sensors, a test that is called as a switch is."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from thermodata.draft.words.naming import words
from thermodata.draft.words.vocabulary import places_in

_WHEN = re.compile(r"\W*(?:\d{1,4}[./-]\d{1,2}[./-]\d{1,4}|\d{1,2}:\d{2})(?!\d)")


@dataclass(frozen=True, slots=True)
class OfName:
    """name: as its first line has it; text: what it is; others: what lines say that do not agree with that."""

    name: str
    text: str
    others: tuple[str, ...] = ()


def begins_with_a_time(text: str) -> bool:
    """Whether a text begins with when something was, as the line of a test does: '12.05.2026 06:30 to 12:30'."""
    return _WHEN.match(text) is not None


def of_names(rows: Sequence[tuple[str, str]], is_words: Callable[[str], bool]) -> Mapping[str, OfName]:
    """The name in lower case -> what its rows (name, text) agree on, else what the first says that is a description."""
    texts: dict[str, tuple[str, dict[str, str]]] = {}
    for name, text in rows:
        if is_words(text) and not begins_with_a_time(text):
            texts.setdefault(name.casefold(), (name, {}))[1].setdefault(text.casefold(), text)
    return {word: _agreed(name, list(said.values())) for word, (name, said) in texts.items()}


def _agreed(name: str, texts: Sequence[str]) -> OfName:
    shortest = min(texts, key=len)
    if all(re.search(rf"(?<!\w){re.escape(shortest)}(?!\w)", text, re.IGNORECASE) for text in texts):
        return OfName(name, shortest)
    return OfName(name, texts[0], tuple(text for text in texts[1:] if _elsewhere(text, texts[0])))


def _elsewhere(text: str, other: str) -> bool:
    """Whether two texts speak of different parts of the machine: 'bed' and 'column, rear', but not 'eddy probe Z' and
    'eddy probe in a fixture'."""
    one, two = places_in(words(text)), places_in(words(other))
    return not (one <= two or two <= one)


__all__ = ["OfName", "begins_with_a_time", "of_names"]
