"""What columns of a table say of how good the values of others are."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Array
from thermodata.reader.text.rows.quality_columns import (
    QUALITY_OF,
    SHOWN,
    STATE_OF,
    Pairs,
    Told,
    bad_rows,
    quality_pairs,
    said_of_codes,
    second_pairs,
    states,
    values_of,
    worded,
)


@dataclass(frozen=True, slots=True)
class Qualities:
    """of_values: value column -> (the column of its quality, whether the code 0 is good); of_rows: the same of whole
    rows, for values that have a quality of their own too; states: column of codes that are not known -> the value
    beside it."""

    of_values: Pairs = field(default_factory=dict)
    of_rows: Pairs = field(default_factory=dict)
    states: Mapping[str, str] = field(default_factory=dict)

    def properties(self, name: str) -> dict[str, str]:
        """The properties of a column: the values that it flags, or the one whose state it tells."""
        values = [value for each in (self.of_values, self.of_rows) for value, (own, _) in each.items() if own == name]
        if values:
            return {QUALITY_OF: ", ".join(values)}
        return {STATE_OF: self.states[name]} if name in self.states else {}

    def flagged(self, flags: Mapping[str, Array], values: Mapping[str, Array]) -> dict[str, Array]:
        """The flags of values, with those of the rows that their qualities call bad; shape (n,) each."""
        found = dict(flags)
        for name, (own, zero) in (*self.of_values.items(), *self.of_rows.items()):
            if name in values and own in values and (bad := bad_rows(values[own], zero, own)).any():
                found[name] = found.get(name, np.zeros(bad.size, np.uint16)) | bad
        return found

    def of_words(self, columns: Mapping[str, Sequence[str]]) -> set[str]:
        """The qualities that hold words or hexadecimal codes: text, however few these are. columns: sampled cells."""
        return worded(columns, self.of_values) | worded(columns, self.of_rows)

    def notes(self, columns: Mapping[str, Sequence[str]]) -> list[str]:
        """What a user is told: of qualities of several values, of faults, of codes that are not known. columns: sampled
        cells."""
        return [
            *_of_several({**self.of_values, **self.of_rows}),
            *said_of_codes(columns, self.states, self.of_values, self.of_rows),
        ]


def find_qualities(columns: Mapping[str, Sequence[str]], told: Told, measured: Collection[str] = ()) -> Qualities:
    """columns: name -> sampled cells; told: as in `quality_pairs`; measured: those with a unit."""
    pairs = quality_pairs(columns, told, measured)
    return Qualities(pairs, second_pairs(columns, pairs, told, measured), states(columns, pairs, measured))


def _of_several(pairs: Pairs) -> list[str]:
    """A note on each quality column that flags the values of several others."""
    return [
        f"'{own}' is taken for the quality of all {len(values)} values of its row ({', '.join(values[:SHOWN])}"
        f"{', ...' if len(values) > SHOWN else ''}): where it is bad they do not count"
        for own, values in values_of(pairs).items()
        if len(values) > 1
    ]
