"""Each signal to its time: by name, by length, by a declared step, or by the struct that holds both."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from thermodata.errors import FormatError
from thermodata_reader_table.mat.planned import names as say
from thermodata_reader_table.mat.planned.signal_structs import Record
from thermodata_reader_table.mat.planned.signal_structs import texts as lines_of
from thermodata_reader_table.mat.planned.stream_plan import (
    Column,
    Plan,
    Scope,
    Stream,
    TimeVector,
    described,
    same_time,
    upwards,
)
from thermodata_reader_table.mat.tree import Cells, Numbers, Text

SHORT = 20  # a vector no longer than this, without a time, is a property


def assign_columns(plan: Plan, scope: Scope) -> None:
    """Each column of the scope to the time that its name or its length points to."""
    given = scope.unit_of
    scope.times = [
        a if a.unit or a.texts else replace(a, unit=given.get(_last_part(a.path)) or scope.time_unit)
        for a in scope.times
    ]
    scope.columns = [c if c.unit else replace(c, unit=given.get(_last_part(c.name))) for c in scope.columns]
    left: list[Column] = []
    for column in scope.columns:
        vector = _time_of(plan, scope, column.name, column.length)
        if vector is None:
            left.append(column)
            continue
        _stream_of(plan, vector, scope).columns.append(column)
    step = next((s.step_s for s in upwards(scope) if s.step_s is not None), None)
    sizes = sorted({c.length for c in left if c.length > SHORT})
    if sizes and step is not None:
        for size in sizes:
            vector = TimeVector(scope.path or "grid", size, step_s=step, unit="s")
            _stream_of(plan, vector, scope).columns.extend(c for c in left if c.length == size)
        plan.notes.append(f"'{scope.path or plan.where}' holds no time: rows are {step:.9g} s apart")
        left = [c for c in left if c.length <= SHORT]
    if left:
        shown = ", ".join(f"{c.name} ({c.length})" for c in left[:8]) + (" ..." if len(left) > 8 else "")
        plan.notes.append(f"no time of their length, so not read: {shown}")
        for column in left:
            if column.length <= SHORT:
                scope.properties[column.name] = " ".join(str(v) for v in column.load(0, SHORT))


def _time_of(plan: Plan, scope: Scope, name: str, length: int) -> TimeVector | None:
    for level in upwards(scope):
        fits = [a for a in level.times if a.length == length]
        if len(fits) > 1:
            own = say.squeezed(name.rsplit("/", 1)[-1])
            near = [
                a
                for a in fits
                if (stem := say.without_time(a.path.rsplit("/", 1)[-1]))
                and (stem == own or own.startswith(stem) or own.endswith(stem))
            ]
            if len(near) != 1 and all(same_time(fits[0], a) for a in fits[1:]):
                near = fits[:1]
            if len(near) != 1:
                raise FormatError(
                    f"which is the time of '{name}'?",
                    where=plan.where,
                    expected="one time of its length",
                    got=", ".join(a.path for a in fits),
                    hint=f"declare table: {{time: {{column: {fits[0].path}}}}}",
                )
            return near[0]
        if fits:
            return fits[0]
    return None


def _stream_of(plan: Plan, vector: TimeVector, scope: Scope) -> Stream:
    """The stream of a time; made where it is the first of its kind."""
    found = next((s for s in plan.streams if same_time(s.time, vector)), None)
    if found is None:
        found = Stream(vector, properties=described(scope))
        plan.streams.append(found)
    return found


def assign_record(plan: Plan, scope: Scope, path: str, record: Record) -> None:
    """A struct that is one signal to the time that it holds itself, or to one beside or above it."""
    node, time = record.data, record.time
    texts = lines_of(time) if isinstance(time, Text | Cells) else None
    vector: TimeVector | None = None
    longest = max(node.rows, node.columns)
    if isinstance(time, Numbers) and time.is_vector:
        vector = TimeVector(f"{path}/time", time.size, time.vector, unit=record.time_unit)
    elif texts is not None and len(texts) > 1:
        vector = TimeVector(f"{path}/time", len(texts), texts=tuple(texts))
    elif record.step_s is not None and record.step_s > 0:
        vector = TimeVector(f"{path}/time", longest, step_s=record.step_s, zero_s=record.zero, unit="s")
    else:
        vector = next(
            (a for n in (node.rows, node.columns, longest) if (a := _time_of(plan, scope, path, n)) is not None),
            None,
        )
    step = next((s.step_s for s in upwards(scope) if s.step_s is not None), None)
    if vector is None and step is not None:
        vector = TimeVector(scope.path or "grid", longest, step_s=step, unit="s")
    name = record.title or path
    if vector is None or vector.length not in (node.rows, node.columns):
        plan.notes.append(f"no time of its length, so not read: {path} ({longest})")
        return
    stream = _stream_of(plan, vector, scope)
    side = 0 if node.rows == vector.length else 1
    count = node.columns if side == 0 else node.rows
    for i in range(count):
        stream.columns.append(
            Column(
                name if count == 1 else f"{name}({i + 1})",
                record.unit,
                node.dtype,
                vector.length,
                partial(node.line, i, side),
                record.said,
            )
        )


def _last_part(path: str) -> str:
    return path.rsplit("/", 1)[-1]
