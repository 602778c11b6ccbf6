"""Names that every language takes: none of its words, and each once whatever the case."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import count

from thermodata.store.base.files import plain_name

# structured text, C and Python, and what the program itself is made of; in lower case
_WORDS = """
abs action and any array as assert async at auto await begin bool break by byte case char class configuration const
constant continue date def default del dint div do double dt dword elif else elsif end en eno enum except exit exp
export expt extends extern false finally float for from function global goto if import in inline input int interface
is lambda len ln lint log long lreal lword max method min mod move mux none nonlocal not of or out output pass pi
program raise range real register repeat resource restrict result retain return sel self short signed sin cos tan
sint sizeof sqrt static step string struct sum switch then this time to tod true try type typedef udint uint ulint
union unsigned until using usint var version void volatile while with word xor yield d k m t
restart running starting wanted fault limited displacement correction gap change cycle_s inputs name state
start_count start_bins start_mean
"""
RESERVED = frozenset(_WORDS.split())
_HOISTED = re.compile(r"tmp_\d+")  # what statements call a part of a formula


@dataclass
class Names:
    """Names that are taken, in lower case: structured text does not see the case."""

    names: set[str] = field(default_factory=set)

    def take(self, wanted: str, made: Sequence[str] = ()) -> str:
        """A free name like the one that is wanted. made: what is made of it, 'valid_{}', which is free as well, and is
        taken with it."""
        base = plain_name(wanted, "A-Za-z0-9_")
        base = f"m_{base}" if base[0].isdigit() else base
        tries = (base if i == 0 else f"{base}_{i + 1}" for i in count())
        name = next(n for n in tries if self._is_free(n, made))
        self.names |= _all(name, made)
        return name

    def _is_free(self, name: str, made: Sequence[str]) -> bool:
        if name.lower() in RESERVED or _HOISTED.fullmatch(name.lower()):
            return False
        return self.names.isdisjoint(_all(name, made))


def _all(name: str, made: Sequence[str]) -> set[str]:
    """A name and what is made of it, in lower case."""
    return {one.format(name).lower() for one in ("{}", *made)}


def identifier(text: str) -> str:
    """A name that all languages take."""
    return Names().take(text)
