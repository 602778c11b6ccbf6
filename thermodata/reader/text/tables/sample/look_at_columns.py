"""What the sampled cells of a table say of its columns: kinds, decimal mark, units in rows, and what they say of each
other."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from thermodata.errors import FormatError
from thermodata.reader.signals.row_units import UnitColumn
from thermodata.reader.text.cells.values.status import declared_zero
from thermodata.reader.text.names.unit_cells import refuse_units_in_cells, unit_note
from thermodata.reader.text.names.unit_column import paired_units, unit_column, unit_column_note
from thermodata.reader.text.rows.grid import TIME
from thermodata.reader.text.rows.qualities import Qualities, find_qualities
from thermodata.reader.text.tables.sample.columns import ask_for_thousands, dtype_of_counts, find_decimal, kind_of
from thermodata.reader.text.tables.sample.sampled import Sampled
from thermodata.reader.text.tables.sample.standing_columns import standing_columns
from thermodata.reader.text.tables.sample.told_thousands import told_thousands
from thermodata.reader.times.open_questions import UNKNOWN, unanswered


@dataclass(frozen=True, slots=True)
class Columns:
    """What `Table` has of the same names. decimal_is_told: declared, or told by thousands, as a note says."""

    kinds: tuple[str | None, ...]
    qualities: Qualities
    decimal: str | None
    decimal_is_told: bool
    unit: UnitColumn | None
    paired: tuple[UnitColumn, ...]
    units_told: str | None
    stands: frozenset[int]
    notes: tuple[str, ...]


def look_at_columns(table: Sampled, texts: Collection[str], delimiter: str) -> Columns:
    """texts: names of columns that are text whatever their cells. FormatError: no values; QuestionError: cells that can
    be read in two ways."""
    said, layout, groups, where = table.said, table.layout, table.groups, table.where
    cells_of = table.cells()
    units = dict(zip(layout.names, layout.units, strict=True))
    own_cells = {layout.names[i]: cells_of[layout.names[i]] for g in groups for i in g.group.columns}
    measured = {name for name, unit in units.items() if unit}
    qualities = find_qualities(own_cells, lambda zero, name: declared_zero(said, zero, name, where), measured)
    forced = {*texts, *qualities.of_words(cells_of)}
    kinds = _kinds(table, cells_of, forced)
    times = {layout.names[i] for i in layout.time}
    values = {name: kind for name, kind in zip(layout.names, kinds, strict=True) if name not in times}
    words = [name for name, kind in values.items() if kind == "str" and name not in forced]
    _refuse_without_values(table, values, words, cells_of)
    numbers = {name: cells_of[name] for name, kind in zip(layout.names, kinds, strict=True) if kind == "float64"}
    decimal = _decimal(said.get("decimal"), numbers, delimiter, where)
    bare = {name: kind for name, kind in values.items() if units[name] is None}
    unit = unit_column(bare, cells_of) if len(groups) == 1 else None
    paired = paired_units(bare, cells_of) if len(groups) == 1 and unit is None else ()
    for one in (*paired, *([unit] if unit else [])):
        if one.others:  # what is converted is whole no more
            kinds[layout.names.index(one.of)] = "float64"
    bare = {name: kind for name, kind in bare.items() if not any(name in (one.column, one.of) for one in paired)}
    units_told = unit.note() if unit else unit_column_note(bare, cells_of)
    stands, standing_note = standing_columns(table, kinds, cells_of, qualities.of_values)
    notes = (
        decimal.note,
        *(unit_note(cells_of[name], name) for name in words),
        *qualities.notes(own_cells),
        standing_note,
        units_told,
        *(one.note() for one in paired),
    )
    return Columns(
        kinds=tuple(kinds),
        qualities=qualities,
        decimal=decimal.mark,
        decimal_is_told=decimal.is_told,
        unit=unit,
        paired=paired,
        units_told=units_told,
        stands=stands,
        notes=tuple(note for note in notes if note),
    )


def _kinds(table: Sampled, cells_of: Mapping[str, list[str]], texts: Collection[str]) -> list[str | None]:
    """The dtype of each column, None for one without values. texts: columns that are text whatever their cells."""
    layout = table.layout
    times = {
        i: TIME if g.formats else "float64" if g.group.epoch is None else dtype_of_counts(cells_of[layout.names[i]])
        for g in table.groups
        for i in g.group.time
    }
    return [
        times[i] if i in times else "str" if name in texts else kind_of(cells_of[name], name, layout.units[i])
        for i, name in enumerate(layout.names)
    ]


def _refuse_without_values(
    table: Sampled, kinds: Mapping[str, str | None], words: Sequence[str], cells_of: Mapping[str, list[str]]
) -> None:
    """kinds: of the columns beside the time; words: those of them that are text by their cells alone."""
    if not any(kind is not None for kind in kinds.values()):
        raise FormatError(
            "no column beside the time",
            where=table.where,
            expected="values",
            got=", ".join(table.layout.names),
            hint="a file of times alone has nothing to read; if one of the columns is none, declare the "
            "time: table: {time: {column: NAME}}",
        )
    if all(kind in (None, "str") for kind in kinds.values()):
        refuse_units_in_cells([c for name in words for c in cells_of[name]], table.where)


@dataclass(frozen=True, slots=True)
class _Decimal:
    """is_told: declared, or told by thousands, as the note says."""

    mark: str | None
    is_told: bool
    note: str | None = None


def _decimal(declared: str | None, numbers: Mapping[str, list[str]], delimiter: str, where: str) -> _Decimal:
    """numbers: the cells of the columns of numbers."""
    if declared == UNKNOWN:
        raise unanswered("decimal", "'.' or ','", where)
    if declared is not None:
        return _Decimal(declared, is_told=True)
    columns = list(numbers.values())
    if (told := told_thousands(columns)) is not None:
        return _Decimal(told.decimal, is_told=True, note=told.note)
    mark = find_decimal(columns, delimiter, where)
    ask_for_thousands(numbers, mark, where)
    return _Decimal(mark, is_told=False)
