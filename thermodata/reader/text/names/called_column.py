"""Which column of a table somebody means: by its name, its name without the unit, or its place."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.reader.text.names.header import split_unit

_PLACE = re.compile(r"(?:column\s+)?(?P<n>\d{1,6})", re.IGNORECASE)


def by_name(wanted: str, names: Sequence[str]) -> int | None:
    """The place of a column, from 0, by its name, in other letter case too where one alone is called so."""
    for fold in (str, str.casefold):
        hits = [i for i, n in enumerate(names) if fold(wanted) in (fold(n), fold(split_unit(n)[0]))]
        if len(hits) == 1:
            return hits[0]
    return None


def by_name_or_place(wanted: str, names: Sequence[str]) -> int | None:
    """The same; where none is called so, `column 3` or `3` is the third, though it has a name."""
    if wanted in names or (found := _PLACE.fullmatch(wanted.strip())) is None:
        return by_name(wanted, names)
    place = int(found["n"]) - 1
    told = f"column {place + 1}"  # names that are not of all columns of the table have it as what it is called
    if told in names:
        return names.index(told)
    return place if 0 <= place < len(names) else None
