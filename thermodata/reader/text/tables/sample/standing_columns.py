"""Which columns of a table stand over the empty cells behind them: as it is declared, or as its cells tell."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from thermodata.reader.text.cells.cell import number_of
from thermodata.reader.text.page.layout import Layout
from thermodata.reader.text.rows.changed_cells import KEY, declared_standing, find_standing
from thermodata.reader.text.rows.quality_columns import Pairs
from thermodata.reader.text.tables.sample.sampled import Sampled
from thermodata.reader.text.tables.table import TimedGroup
from thermodata.reader.text.times.several_cells.date_parts import row_time
from thermodata.reader.times.zone import NAT


def standing_columns(
    table: Sampled, kinds: Sequence[str | None], cells_of: Mapping[str, Sequence[str]], quality: Pairs
) -> tuple[frozenset[int], str | None]:
    """(columns whose values stand over the empty cells behind them, a note): as declared, or as the cells tell. The
    quality of such a value stands as it does, or a bad one would be good from the next row on."""
    layout, groups = table.layout, table.groups
    columns = [i for g in groups for i in g.group.columns]
    names = [layout.names[i] for i in columns if kinds[i] is not None]
    qualities = {own for own, _ in quality.values()}
    told = declared_standing(table.said.get(KEY), [layout.names[i] for i in columns], table.where, layout.names)
    note = None
    if told is None:
        if len(groups) > 1 or groups[0].group.counted or _runs_back(groups[0], layout, cells_of):
            return frozenset(), None
        told, note = find_standing({name: cells_of[name] for name in names if name not in qualities})
    told |= {own for value, (own, _) in quality.items() if value in told}
    return frozenset(i for i, name in enumerate(layout.names) if name in told), note


def _runs_back(timed: TimedGroup, layout: Layout, cells_of: Mapping[str, Sequence[str]]) -> bool:
    """Whether a table stands newest first: there a value does not stand over the cells below it."""
    columns = [cells_of[layout.names[i]] for i in timed.group.time]
    ends = ([c[0] for c in columns], [c[-1] for c in columns]) if columns and columns[0] else None
    if ends is None:
        return False
    if timed.formats:
        first, last = (row_time(cells, timed.formats) for cells in ends)
        return NAT not in (first, last) and last < first
    first_s, last_s = (number_of(cells[0]) for cells in ends)
    return first_s is not None and last_s is not None and last_s < first_s
