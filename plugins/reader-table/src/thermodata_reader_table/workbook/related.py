"""Columns of a sheet that say something of each other: values that stand over empty cells, and qualities."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from thermodata.plugin import Array
from thermodata.reader.times.zone import NAT
from thermodata.reader.typed_columns import Columns, Related, Relating, related
from thermodata_reader_table.workbook.sheet import Stream


def with_related(
    stream: Stream, said: Mapping[str, Any] | None, where: str, *, told_by_cells: bool, beyond: Collection[str]
) -> tuple[Stream, Related]:
    """The stream with what stands and the flags of bad values, in the rows that have a time. Errors: `related`."""
    good = stream.times.t_ns != NAT
    values = {name: v[good] for name, v in stream.values.items()}
    empty = {name: e[good] for name, e in stream.empty.items()}
    measured = {name for name, unit in stream.units.items() if unit}
    columns = Columns(values, empty, stream.times.t_ns, measured)
    found = related(said, columns, where, told_by_cells=told_by_cells, beyond=beyond)
    if not (found.stands or found.qualities.of_values or found.qualities.states):
        return stream, found
    flags = {name: f[good] for name, f in stream.flags.items()}
    values, flags = Relating(found).over(values, flags, empty)

    def of_all_rows(known: Mapping[str, Array], others: Mapping[str, Array]) -> dict[str, Array]:
        made: dict[str, Array] = {}
        for name, some in known.items():
            made[name] = others[name].copy() if name in others else np.zeros(good.size, some.dtype)
            made[name][good] = some
        return made

    own = {name: {**properties, **found.qualities.properties(name)} for name, properties in stream.said.items()}
    return replace(
        stream,
        values=of_all_rows(values, stream.values),
        flags=of_all_rows(flags, stream.flags),
        said=own,
        held=found.stands,
    ), found
