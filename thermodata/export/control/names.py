"""Names that every language takes: none of its words, and each once whatever the case."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import count

from thermodata.store.base.files import plain_name

# structured text, C and Python, and what the program itself is made of; in lower case
_WORDS = """
abs action and any array at begin bool by byte case char class configuration const constant date def del dint div do
double dt dword elif else elsif end en eno except exit exp export expt extends false float for from function global
goto if import in input int interface is lambda len ln lint log long lreal lword max method min mod move mux none not
of or out output pass pi program raise range real repeat resource result retain return sel self short signed sin cos
tan sint sizeof sqrt static step string struct sum switch then this time to tod true try type udint uint ulint union
unsigned until using usint var version void volatile while with word xor yield d k m t
restart running starting wanted fault limited displacement correction gap change cycle_s inputs name state
start_count start_bins start_mean
"""
RESERVED = frozenset(_WORDS.split())


@dataclass
class Names:
    """Names that are taken, in lower case: structured text does not see the case."""

    names: set[str] = field(default_factory=set)

    def take(self, wanted: str) -> str:
        """A free name like the one that is wanted."""
        base = plain_name(wanted, "A-Za-z0-9_")
        base = f"m_{base}" if base[0].isdigit() else base
        tries = (base if i == 0 else f"{base}_{i + 1}" for i in count())
        name = next(n for n in tries if n.lower() not in self.names and n.lower() not in RESERVED)
        self.names.add(name.lower())
        return name


def identifier(text: str) -> str:
    """A name that all languages take."""
    return Names().take(text)
