"""Matrices: a signal a column (or row), and the time one of these or a vector beside them."""

from __future__ import annotations

from functools import partial

from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Loss
from thermodata.reader.text import split_unit
from thermodata_reader_table.mat.planned import names as say
from thermodata_reader_table.mat.planned.described_by import fitting, scales_of, unit_of
from thermodata_reader_table.mat.planned.stream_plan import (
    LOOK,
    MOST_SIGNALS,
    Column,
    Plan,
    Scope,
    TimeVector,
    rises,
    upwards,
)
from thermodata_reader_table.mat.tree import Numbers


def sort_matrices(plan: Plan, scope: Scope) -> None:
    """The columns of the scope's matrices as signals, and one of them as the time where it is one."""
    for path, node in scope.matrices:
        lengths = {a.length for a in scope.times} or {node.rows if node.rows >= node.columns else node.columns}
        axis = 0 if node.rows in lengths or node.columns not in lengths else 1
        count, length = (node.columns, node.rows) if axis == 0 else (node.rows, node.columns)
        if count > MOST_SIGNALS:
            raise FormatError(
                "more signals than any lab has",
                where=f"{plan.where} {path}",
                got=str(count),
                expected=f"at most {MOST_SIGNALS}",
                hint="transpose it where its rows are the samples",
            )
        heads = fitting(scope, "names", count, path)
        if plan.cut and heads is None:
            plan.losses.append(
                Loss(
                    f"{plan.where} variable '{path}'",
                    reason="the file is cut, and the names of its columns may stand in what is lost",
                )
            )
            continue
        units = fitting(scope, "units", count, path) or [unit_of(scope, path) or ""] * count
        names = [f"{path}/{h}" if h else "" for h in heads] if heads and len(scope.matrices) > 1 else heads
        said = scales_of(scope, count, path)
        made = []
        for i in range(count):
            own = (names[i] if names else "") or (f"{path}(:,{i + 1})" if axis == 0 else f"{path}({i + 1},:)")
            unit = (units[i] if i < len(units) else "") or split_unit(own if names else "")[1]
            made.append(Column(own, unit or None, node.dtype, length, partial(node.line, i, axis), said[i]))
        at = _time_column(plan, scope, path, node, axis, heads, length)
        if at is not None:
            scope.times.append(TimeVector(made[at].name, length, made[at].load, unit=made[at].unit))
            made.pop(at)
        scope.columns.extend(made)


def _time_column(
    plan: Plan, scope: Scope, path: str, node: Numbers, axis: int, heads: list[str] | None, length: int
) -> int | None:
    """The column of a matrix that is its time, or None where another variable is."""
    if isinstance(plan.wanted, int):
        count = node.columns if axis == 0 else node.rows
        if not 1 <= plan.wanted <= count:
            raise UsageError(
                f"no column {plan.wanted}",
                where=f"{plan.where} {path}",
                expected=f"1 to {count}",
                got=str(plan.wanted),
                hint="columns count from 1",
            )
        return plan.wanted - 1
    if heads and isinstance(plan.wanted, str):
        return next((i for i, h in enumerate(heads) if plan.wanted in (h, split_unit(h)[0])), None)
    if (
        plan.wanted is not None
        or scope.step_s is not None
        or any(a.length == length for s in upwards(scope) for a in s.times)
    ):
        return None
    if heads:
        return next((i for i, h in enumerate(heads) if say.names_time(split_unit(h)[0])), None)
    rising = [
        i for i in range(min(node.columns if axis == 0 else node.rows, 200)) if rises(node.line(i, axis, 0, LOOK))
    ]
    if rising == [0]:
        plan.notes.append(
            f"'{path}' has no names: its first {'column' if axis == 0 else 'row'}, the only one "
            "that always rises, is taken as the time"
        )
        return 0
    return None
