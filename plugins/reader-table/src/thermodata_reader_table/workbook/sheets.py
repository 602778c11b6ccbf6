"""Which sheets of a workbook are tables that are read: a summary beside recordings is none."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from thermodata.errors import QuestionError, ThermodataError
from thermodata.plugin import Source
from thermodata.reader.text.page.layout import Layout, find_layout
from thermodata.reader.text.page.on_its_side import refuse_sideways
from thermodata_reader_table.workbook.book import Sheet
from thermodata_reader_table.workbook.sheet import Stream

_SMALL = 2  # times as many rows have the recordings beside a summary


def layouts_of(sheets: Mapping[str, Sheet], source: Source, file: str) -> tuple[dict[str, Layout], list[str]]:
    """(how each sheet that is a table lies, notes on the others); the reason of the first where none is, and what one
    leaves open."""
    tables: dict[str, Layout] = {}
    refused: dict[str, ThermodataError] = {}
    for sheet, cells in sheets.items():
        where = f"{file} sheet '{sheet}'"
        try:
            if not (source.table or {}).get("time"):
                refuse_sideways(cells.rows, where)
            tables[sheet] = find_layout(cells.rows[:500], source.table, where)
        except ThermodataError as error:
            refused[sheet] = _naming(sheet, error) if len(sheets) > 1 else error
    # a list of numbers may be no recording; a time without its unit is one, but for a summary beside dates
    dated = [s for s, t in tables.items() if t.of_dates]
    questions = {s: e for s, e in refused.items() if isinstance(e, QuestionError) and not is_small(s, dated, sheets)}
    asked = [e for e in questions.values() if "period" not in e.declare.get("time", {})]
    if asked or not tables:
        raise next(iter(asked or refused.values()))
    return tables, [left_out(s, e) for s, e in refused.items()]


def is_small(sheet: str, others: Iterable[str], sheets: Mapping[str, Sheet]) -> bool:
    """Whether a sheet is a summary by its rows, beside others that are recordings."""
    return _SMALL * len(sheets[sheet].rows) <= max((len(sheets[s].rows) for s in others if s != sheet), default=0)


def left_out(sheet: str, error: ThermodataError) -> str:
    """The note on a sheet that is not read."""
    return f"sheet '{sheet}' is not read as a table: {error.what}"


def _naming(sheet: str, error: ThermodataError) -> ThermodataError:
    """A question of a sheet among several says which one leaves it."""
    if not isinstance(error, QuestionError):
        return error
    return QuestionError(
        error.what,
        where=error.where,
        expected=error.expected,
        got=error.got,
        hint=error.hint,
        ask=f"sheet '{sheet}': {error.ask}",
        declare=error.declare,
        meanwhile=error.meanwhile,
        times=error.times,
    )


def of_another_clock(found: Mapping[str, Sequence[Stream]]) -> list[str]:
    """The few sheets with dates beside many that count from a start, or the other way: a list of tests with their days
    is no recording. None where they are no small minority: then nobody can tell which are meant."""
    kinds = {sheet: {s.times.absolute for s in streams if s.times.t_ns.size} for sheet, streams in found.items()}
    few, many = sorted(([s for s, kind in kinds.items() if kind == {dated}] for dated in (True, False)), key=len)
    return few if len(few) + len(many) == len(kinds) and len(many) >= max(3, 2 * len(few)) else []
