"""Whether a name holds a listed word, and which of its words none of the listed ones touches.

A word is looked for anywhere in the name; 'nut.' is a whole word only, '^hall' the beginning of one, 'spindle~speed'
words one after the other, parted or not, and the last of them whole but for a '~' behind it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from thermodata.draft.words.naming import without_marks

_BEGINS, _ENDS = r"(?<!\S)", r"(?!\S)"


@dataclass(frozen=True, slots=True)
class _Word:
    """core: its letters, in which a blank may be missing, or an expression. begins, ends: as a word of the name."""

    core: str
    begins: bool
    ends: bool

    @property
    def expression(self) -> str:
        core = self.core if "[" in self.core else re.escape(self.core).replace(r"\ ", r"\s?")
        return core + (_ENDS if self.ends else "")

    @property
    def is_plain(self) -> bool:
        return "[" not in self.core and not re.search(r"\s", self.core)


@dataclass(frozen=True, slots=True)
class _Listed:
    """The words of a list by how they are looked for: most are found without an expression, in a fifth of the time."""

    whole: frozenset[str]
    inside: tuple[str, ...]
    other: re.Pattern[str] | None


def holds_word(listed: str, text: str) -> bool:
    """Whether a name (as words()) holds one of the listed words."""
    words = _taken_apart(listed)
    if not words.whole.isdisjoint(text.split()):
        return True
    for word in words.inside:  # not by any(): a generator takes as long as what it looks at
        if word in text:
            return True
    return words.other is not None and words.other.search(text) is not None


def beyond(listed: str, text: str) -> tuple[str, ...]:
    """The words of a name (as words()) that none of the listed ones touches."""
    found = [m.span() for m in _pattern(listed).finditer(text)]
    return tuple(m[0] for m in re.finditer(r"\S+", text) if not any(a < m.end() and m.start() < b for a, b in found))


@lru_cache(maxsize=256)
def _taken_apart(listed: str) -> _Listed:
    words = [_word(word) for word in listed.split()]
    whole = frozenset(word.core for word in words if word.is_plain and word.begins and word.ends)
    inside = tuple(word.core for word in words if word.is_plain and not word.begins and not word.ends)
    others = [word for word in words if not word.is_plain or word.begins != word.ends]
    # those that begin a word look at one letter of each word of the name
    first = "|".join(word.expression for word in others if word.begins)
    expressions = [f"{_BEGINS}(?:{first})"] if first else []
    expressions += [word.expression for word in others if not word.begins]
    return _Listed(whole, inside, re.compile("|".join(expressions)) if expressions else None)


@lru_cache(maxsize=256)
def _pattern(listed: str) -> re.Pattern[str]:
    """The words of a list as one expression, in their order."""
    words = [_word(word) for word in listed.split()]
    return re.compile("|".join((_BEGINS if word.begins else "") + word.expression for word in words))


def _word(written: str) -> _Word:
    whole, first = written.endswith("."), written.startswith("^")
    phrase = "~" in written and not first
    core = without_marks(written.strip("^.").replace(".~", "~").replace("~", " "))
    return _Word(core, whole or first or phrase, whole or (phrase and written[-1] != "~"))
