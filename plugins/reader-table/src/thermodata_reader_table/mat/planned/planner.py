"""Which arrays of a MAT file are times, which are their signals: by names, lengths and structs. Ambiguity is asked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from thermodata.errors import FormatError, UsageError, nearest
from thermodata.reader.text.clocks.time_groups import one_time
from thermodata.reader.text.preamble.scale_words import spellings
from thermodata_reader_table.mat.planned.date_vectors import take_date_vectors, take_weeks
from thermodata_reader_table.mat.planned.described_by import settle_lists
from thermodata_reader_table.mat.planned.matrices import sort_matrices
from thermodata_reader_table.mat.planned.signal_structs import as_record
from thermodata_reader_table.mat.planned.stream_plan import MOST_SIGNALS, Column, Plan, Scope
from thermodata_reader_table.mat.planned.time_assignment import assign_columns, assign_record
from thermodata_reader_table.mat.planned.variable_roles import lose_object, sort_variable
from thermodata_reader_table.mat.tree import Node, Numbers, Odd, Struct, Text, Tree


def plan_streams(tree: Tree, said: Mapping[str, Any], where: str) -> Plan:
    """The streams of a file's variables. said: the table that the campaign file declares; where: the file's name.

    FormatError: no time, or no signals, or more than one time for a signal. UsageError: what is declared is not there.
    """
    wanted = one_time(said, where).get("column")
    if isinstance(wanted, list):
        raise UsageError(
            "a MAT file has one time for a stream",
            where=where,
            got=str(wanted),
            expected="table: {time: {column: NAME}}",
            hint="name one; streams of other times are told by themselves",
        )
    plan = Plan(where, wanted, tree.complete is False, notes=list(tree.notes), losses=list(tree.losses))
    variables = dict(tree.variables)
    sheet = said.get("sheet")
    if sheet is not None:
        if sheet not in variables:
            close = nearest(str(sheet), list(variables))
            raise UsageError(
                f"no variable '{sheet}'",
                where=where,
                got=str(sheet),
                expected=", ".join(list(variables)[:30]),
                hint=f"did you mean '{close}'?" if close else "'sheet' of a MAT file is the name of a variable",
            )
        variables = {sheet: variables[sheet]}
    if not variables and not plan.losses:
        raise FormatError(
            "a MAT file without variables",
            where=where,
            hint="save it again: save('test.mat', 't', 'dZ')",
        )
    _scope(plan, variables, "", None)
    if sum(len(s.columns) for s in plan.streams) > MOST_SIGNALS:
        raise FormatError(
            "more signals than any lab has",
            where=where,
            expected=f"at most {MOST_SIGNALS}",
            hint="save the measured variables alone",
        )
    if not any(s.columns for s in plan.streams):
        raise _nothing_found(plan, variables)
    plan.streams = [s for s in plan.streams if s.columns]
    if plan.stated:
        for stream in plan.streams:
            stream.columns = [_with_stated(plan, column) for column in stream.columns]
    return plan


def _with_stated(plan: Plan, column: Column) -> Column:
    """A signal with what variables called after it state of its scale."""
    said = {k: v for name in spellings(column.name) for k, v in plan.stated.get(name, {}).items()}
    return replace(column, said={**said, **column.said}) if said else column


def _scope(plan: Plan, fields: Mapping[str, Node], path: str, above: Scope | None) -> None:
    scope = Scope(path, above, frozenset(fields))
    inner: list[tuple[str, Struct]] = []
    for name, node in fields.items():
        sort_variable(plan, scope, name, node, inner)
    take_date_vectors(plan, scope)
    take_weeks(plan, scope)
    settle_lists(plan, scope)
    sort_matrices(plan, scope)
    assign_columns(plan, scope)
    for where, struct in inner:
        record = as_record(struct)
        if record is None:
            _scope(plan, struct.fields, where, scope)
        else:
            assign_record(plan, scope, where, record)
            plan.notes += [f"'{where}/{name}' is no text: the signal goes without it" for name in record.odd]
            for name, node in struct.fields.items():
                if isinstance(node, Odd):
                    lose_object(plan, f"{where}/{name}", node)


def _nothing_found(plan: Plan, variables: Mapping[str, Node]) -> FormatError:
    shown = ", ".join(f"{k} ({_size(v)})" for k, v in list(variables.items())[:12]) or "nothing readable"
    if plan.losses and all(isinstance(v, Odd | Text) for v in variables.values()):
        return FormatError(
            "no variable can be read",
            where=plan.where,
            got=plan.losses[0].reason.split(". ")[0],
            expected="vectors, matrices, structs, cells",
            hint=[*plan.losses[0].reason.split(". "), "save the variables as plain vectors"][1],
        )
    return FormatError(
        "no time and signals found",
        where=plan.where,
        got=shown,
        expected="a vector called t, time, Zeit, čas or 时间 as long as the signals; a matrix with "
        "its time in a column; structs with data and time, or dt",
        hint="declare table: {time: {column: NAME or number, unit: s}}, and sheet: VARIABLE to read one variable only",
    )


def _size(node: Node) -> str:
    if isinstance(node, Numbers):
        return f"{node.rows}x{node.columns}"
    return node.kind if isinstance(node, Odd) else type(node).__name__.lower()
