"""A sheet with a column that says the unit of the numbers beside it, row by row: in one unit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.plugin import Loss
from thermodata.reader.signals.interleaved import words_of
from thermodata.reader.signals.row_units import UNIT_OF, in_unit
from thermodata.reader.text.names.unit_column import lost_for_unit
from thermodata.reader.typed_columns import unit_in_rows
from thermodata_reader_table.workbook.sheet import Stream


def in_one_unit(stream: Stream, where: str) -> tuple[Stream, list[str], list[Loss]]:
    """(the stream, notes, losses): rows in a unit that does not convert are left out."""
    said, note = unit_in_rows(stream.values, stream.units)
    notes = [note] if note else []
    if said is None:
        return stream, notes, []
    words = words_of(said.column, stream.values[said.column])
    values, lost, foreign = in_unit(words, stream.values[said.of], said.unit)
    kept = np.flatnonzero(~lost)
    made = replace(
        stream,
        times=replace(stream.times, t_ns=stream.times.t_ns[kept]),
        values={name: v[kept] for name, v in {**stream.values, said.of: values}.items()},
        units={**stream.units, said.of: said.unit},
        at=stream.at[kept],
        flags={name: v[kept] for name, v in stream.flags.items()},
        empty={name: v[kept] for name, v in stream.empty.items()},
        said={**stream.said, said.column: {**stream.said[said.column], UNIT_OF: said.of}},
    )
    return made, notes, [Loss(where, reason=lost_for_unit(said, word, count)) for word, count in foreign.items()]
