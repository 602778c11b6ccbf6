"""Columns of the store whose names are words of SQL too: bare they are no column."""

from __future__ import annotations

import re

_QUOTED = re.compile(r"\"[^\"]*\"|'[^']*'")
_RESERVED = ("at",)


def reserved_hint(query: str) -> str | None:
    """What to write where a query that can't be parsed has such a name bare; None where it has none."""
    bare = _QUOTED.sub(" ", query)
    found = next((word for word in _RESERVED if re.search(rf"(?i)\b{word}\b", bare)), None)
    return None if found is None else f'the column {found} is a word of SQL too: write "{found}"'
