"""Which arrays of a MAT file are times, which are their signals: by names, lengths and structs. Ambiguity is asked."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from thermodata.errors import FormatError, UsageError, nearest
from thermodata.plugin import Array, Loss
from thermodata.reader.text import split_unit
from thermodata.reader.text.time_groups import one_time
from thermodata_reader_table import mat_names as say
from thermodata_reader_table.mat_tree import Cells, Node, Numbers, Odd, Struct, Structs, Text, Tree, refusal

_LOOK = 2000  # values by which a time is judged
_SHORT = 20  # a vector no longer than this, without a time, is a property
_MANY = 100_000  # signals of a file


@dataclass(frozen=True, slots=True)
class Axis:
    """A time of `length` rows. load: None for a grid of step_s from zero_s. texts: dates as text. unit: as the file
    says it, or None."""

    path: str
    length: int
    load: Callable[[int, int], Array] | None = None
    texts: tuple[str, ...] | None = None
    unit: str | None = None
    step_s: float = 0.0
    zero_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Column:
    """One signal: load(start, stop) of its rows; texts where it is one of words."""

    name: str
    unit: str | None
    dtype: str
    length: int
    load: Callable[[int, int], Array]


@dataclass
class Stream:
    axis: Axis
    columns: list[Column] = field(default_factory=list)
    properties: dict[str, str] = field(default_factory=dict)


@dataclass
class Scope:
    """One level of the file: its arrays by path, and what describes them."""

    path: str
    above: Scope | None
    columns: list[Column] = field(default_factory=list)
    matrices: list[tuple[str, Numbers]] = field(default_factory=list)
    axes: list[Axis] = field(default_factory=list)
    names: list[list[str]] = field(default_factory=list)
    units: list[list[str]] = field(default_factory=list)
    unit_of: dict[str, str] = field(default_factory=dict)
    time_unit: str | None = None
    step_s: float | None = None
    properties: dict[str, str] = field(default_factory=dict)


@dataclass
class Plan:
    streams: list[Stream]
    notes: list[str]
    losses: list[Loss]


class Planner:
    """Walks the tree once; `plan` has the streams."""

    def __init__(self, tree: Tree, said: Mapping[str, Any], where: str) -> None:
        self.where, self.notes, self.losses = where, list(tree.notes), list(tree.losses)
        self.streams: list[Stream] = []
        self.cut = tree.complete is False
        time = one_time(said, where)
        self.wanted, self.unit = time.get("column"), time.get("unit")
        if isinstance(self.wanted, list):
            raise UsageError(
                "a MAT file has one time for a stream",
                where=where,
                got=str(self.wanted),
                expected="table: {time: {column: NAME}}",
            )
        variables = dict(tree.variables)
        sheet = said.get("sheet")
        if isinstance(sheet, str):
            if sheet not in variables:
                close = nearest(sheet, list(variables))
                raise UsageError(
                    f"no variable '{sheet}'",
                    where=where,
                    got=sheet,
                    expected=", ".join(list(variables)[:30]),
                    hint=f"did you mean '{close}'?" if close else None,
                )
            variables = {sheet: variables[sheet]}
        if not variables and not self.losses:
            raise FormatError("a MAT file without variables", where=where)
        self._scope(variables, "", None)
        if sum(len(s.columns) for s in self.streams) > _MANY:
            raise FormatError("more signals than any lab has", where=where, expected=f"at most {_MANY}")
        if not any(s.columns for s in self.streams):
            raise self._nothing(variables)

    def plan(self) -> Plan:
        return Plan([s for s in self.streams if s.columns], self.notes, self.losses)

    # ---- the walk ----------------------------------------------------------------------------------

    def _scope(self, fields: Mapping[str, Node], path: str, above: Scope | None) -> None:
        scope = Scope(path, above)
        inner: list[tuple[str, Struct]] = []
        for name, node in fields.items():
            self._sort(scope, name, node, inner)
        self._matrices(scope)
        self._assign(scope)
        for where, struct in inner:
            record = say.as_record(struct)
            if record is None:
                self._scope(struct.fields, where, scope)
            else:
                self._record(scope, where, record)
                self.notes += [f"'{where}/{name}' is no text: the signal goes without it" for name in record.odd]
                for name, node in struct.fields.items():
                    if isinstance(node, Odd):
                        self._odd(f"{where}/{name}", node)

    def _odd(self, path: str, node: Odd) -> None:
        if node.kind != "function_handle":
            self.losses.append(Loss(f"{self.where} variable '{path}'", None, None, None, refusal(node.kind)))

    def _sort(self, scope: Scope, name: str, node: Node, inner: list[tuple[str, Struct]]) -> None:
        path = f"{scope.path}/{name}" if scope.path else name
        if isinstance(node, Struct):
            words = {k: say.one_text(v) for k, v in node.fields.items()}
            if say.names_units(name) and all(words.values()):
                scope.unit_of |= {k: v for k, v in words.items() if v}
            else:
                inner.append((path, node))
        elif isinstance(node, Structs):
            inner.extend((f"{path}({i})", item) for i, item in enumerate(node.items, 1))
        elif isinstance(node, Odd):
            self._odd(path, node)
        elif isinstance(node, Numbers):
            self._numbers(scope, name, path, node)
        else:
            self._texts(scope, name, path, node, inner)

    def _numbers(self, scope: Scope, name: str, path: str, node: Numbers) -> None:
        if node.size == 1:
            value = say.one_number(node)
            if value is not None and say.names_step(name) and value > 0:
                scope.step_s = value
            elif value and say.names_rate(name):
                scope.step_s = 1.0 / value
            scope.properties[name] = f"{value:.12g}"
        elif node.is_vector:
            if self._is_axis(name, path, node):
                scope.axes.append(
                    Axis(path, node.size, node.vector, unit=split_unit(name)[1] or say.unit_in_name(name))
                )
            else:
                scope.columns.append(Column(path, split_unit(name)[1], node.dtype, node.size, node.vector))
        elif node.size:
            scope.matrices.append((path, node))

    def _is_axis(self, name: str, path: str, node: Numbers) -> bool:
        if isinstance(self.wanted, str):
            return self.wanted in (path, name)
        if node.dtype == "bool":
            return False
        return say.names_time(name) or (say.may_be_time(name) and _rises(node.vector(0, _LOOK)))

    def _texts(self, scope: Scope, name: str, path: str, node: Text | Cells, inner: list[tuple[str, Struct]]) -> None:
        lines = say.texts(node)
        if lines is None:
            self._cells(scope, path, node, inner)
        elif len(lines) == 1:
            if say.names_time_unit(name):
                scope.time_unit = lines[0]
            if say.names_names(name) and not say.names_units(name):
                scope.names.append(lines)
            if say.names_units(name):
                scope.units.append(lines)
            scope.properties[name] = lines[0][:500]
        elif lines:
            if say.names_units(name):
                scope.units.append(lines)
            elif (say.names_time(name) and self.wanted is None) or self.wanted in (path, name):
                scope.axes.append(Axis(path, len(lines), texts=tuple(lines)))
            elif say.names_names(name):
                scope.names.append(lines)
            else:
                words = np.array(lines, object)
                scope.columns.append(Column(path, None, "str", len(lines), partial(_part, words)))

    def _cells(self, scope: Scope, path: str, node: Text | Cells, inner: list[tuple[str, Struct]]) -> None:
        items = node.items if isinstance(node, Cells) else ()
        if all(isinstance(item, Struct) for item in items):
            inner.extend((f"{path}{{{i}}}", item) for i, item in enumerate(items, 1) if isinstance(item, Struct))
        elif all(isinstance(item, Numbers) and item.is_vector for item in items):
            for i, item in enumerate(items, 1):
                assert isinstance(item, Numbers)
                scope.columns.append(Column(f"{path}{{{i}}}", None, item.dtype, item.size, item.vector))
        elif items:
            self.losses.append(
                Loss(
                    f"{self.where} variable '{path}'",
                    None,
                    None,
                    None,
                    "a cell array of mixed content: save its columns as vectors",
                )
            )

    # ---- matrices: a signal a column, the time one of them or beside them --------------------------

    def _matrices(self, scope: Scope) -> None:
        for path, node in scope.matrices:
            lengths = {a.length for a in scope.axes} or {node.rows if node.rows >= node.columns else node.columns}
            axis = 0 if node.rows in lengths or node.columns not in lengths else 1
            count, length = (node.columns, node.rows) if axis == 0 else (node.rows, node.columns)
            if count > _MANY:
                raise FormatError(
                    "more signals than any lab has",
                    where=f"{self.where} {path}",
                    got=str(count),
                    expected=f"at most {_MANY}",
                )
            heads = _fitting(scope, "names", count)
            if self.cut and heads is None:
                self.losses.append(
                    Loss(
                        f"{self.where} variable '{path}'",
                        None,
                        None,
                        None,
                        "the file is cut, and the names of its columns may stand in what is lost",
                    )
                )
                continue
            units = _fitting(scope, "units", count) or [""] * len(heads or ())
            names = [f"{path}/{h}" if h else "" for h in heads] if heads and len(scope.matrices) > 1 else heads
            made = []
            for i in range(count):
                own = (names[i] if names else "") or (f"{path}(:,{i + 1})" if axis == 0 else f"{path}({i + 1},:)")
                unit = (units[i] if i < len(units) else "") or split_unit(own if names else "")[1]
                made.append(Column(own, unit or None, node.dtype, length, partial(node.line, i, axis)))
            at = self._time_column(scope, path, node, axis, heads, length)
            if at is not None:
                scope.axes.append(Axis(made[at].name, length, made[at].load, unit=made[at].unit))
                made.pop(at)
            scope.columns.extend(made)

    def _time_column(
        self, scope: Scope, path: str, node: Numbers, axis: int, heads: list[str] | None, length: int
    ) -> int | None:
        """The column of a matrix that is its time, or None where another variable is."""
        if isinstance(self.wanted, int):
            count = node.columns if axis == 0 else node.rows
            if not 1 <= self.wanted <= count:
                raise UsageError(
                    f"no column {self.wanted}",
                    where=f"{self.where} {path}",
                    expected=f"1 to {count}",
                    got=str(self.wanted),
                )
            return self.wanted - 1
        if heads and isinstance(self.wanted, str):
            return next((i for i, h in enumerate(heads) if self.wanted in (h, split_unit(h)[0])), None)
        if (
            self.wanted is not None
            or scope.step_s is not None
            or any(a.length == length for s in _up(scope) for a in s.axes)
        ):
            return None
        if heads:
            return next((i for i, h in enumerate(heads) if say.names_time(split_unit(h)[0])), None)
        rising = [
            i for i in range(min(node.columns if axis == 0 else node.rows, 200)) if _rises(node.line(i, axis, 0, _LOOK))
        ]
        if rising == [0]:
            self.notes.append(
                f"'{path}' has no names: its first {'column' if axis == 0 else 'row'}, the only one "
                "that always rises, is taken as the time"
            )
            return 0
        return None

    # ---- streams -----------------------------------------------------------------------------------

    def _assign(self, scope: Scope) -> None:
        """Each column of the scope to the time that its name or its length points to."""
        given = scope.unit_of
        scope.axes = [
            a if a.unit or a.texts else replace(a, unit=given.get(_last(a.path)) or scope.time_unit) for a in scope.axes
        ]
        scope.columns = [c if c.unit else replace(c, unit=given.get(_last(c.name))) for c in scope.columns]
        left: list[Column] = []
        for column in scope.columns:
            axis = self._axis_of(scope, column.name, column.length)
            if axis is None:
                left.append(column)
                continue
            self._stream(axis, scope).columns.append(column)
        step = next((s.step_s for s in _up(scope) if s.step_s is not None), None)
        sizes = sorted({c.length for c in left if c.length > _SHORT})
        if sizes and step is not None:
            for size in sizes:
                axis = Axis(scope.path or "grid", size, step_s=step, unit="s")
                self._stream(axis, scope).columns.extend(c for c in left if c.length == size)
            self.notes.append(f"'{scope.path or self.where}' holds no time: rows are {step:.9g} s apart")
            left = [c for c in left if c.length <= _SHORT]
        if left:
            shown = ", ".join(f"{c.name} ({c.length})" for c in left[:8]) + (" ..." if len(left) > 8 else "")
            self.notes.append(f"no time of their length, so not read: {shown}")
            for column in left:
                if column.length <= _SHORT:
                    scope.properties[column.name] = " ".join(str(v) for v in column.load(0, _SHORT))

    def _axis_of(self, scope: Scope, name: str, length: int) -> Axis | None:
        for level in _up(scope):
            fits = [a for a in level.axes if a.length == length]
            if len(fits) > 1:
                own = say.squeezed(name.rsplit("/", 1)[-1])
                near = [
                    a
                    for a in fits
                    if (stem := say.without_time(a.path.rsplit("/", 1)[-1]))
                    and (stem == own or own.startswith(stem) or own.endswith(stem))
                ]
                if len(near) != 1 and all(_same_axis(fits[0], a) for a in fits[1:]):
                    near = fits[:1]
                if len(near) != 1:
                    raise FormatError(
                        f"which is the time of '{name}'?",
                        where=self.where,
                        expected="one time of its length",
                        got=", ".join(a.path for a in fits),
                        hint=f"declare table: {{time: {{column: {fits[0].path}}}}}",
                    )
                return near[0]
            if fits:
                return fits[0]
        return None

    def _stream(self, axis: Axis, scope: Scope) -> Stream:
        """The stream of a time; made where it is the first of its kind."""
        found = next((s for s in self.streams if _same_axis(s.axis, axis)), None)
        if found is None:
            found = Stream(axis, properties=_described(scope))
            self.streams.append(found)
        return found

    def _record(self, scope: Scope, path: str, record: say.Record) -> None:
        node, time = record.data, record.time
        texts = say.texts(time) if isinstance(time, Text | Cells) else None
        axis: Axis | None = None
        longest = max(node.rows, node.columns)
        if isinstance(time, Numbers) and time.is_vector:
            axis = Axis(f"{path}/time", time.size, time.vector, unit=record.time_unit)
        elif texts is not None and len(texts) > 1:
            axis = Axis(f"{path}/time", len(texts), texts=tuple(texts))
        elif record.step_s is not None and record.step_s > 0:
            axis = Axis(f"{path}/time", longest, step_s=record.step_s, zero_s=record.zero, unit="s")
        else:
            axis = next(
                (a for n in (node.rows, node.columns, longest) if (a := self._axis_of(scope, path, n)) is not None),
                None,
            )
        step = next((s.step_s for s in _up(scope) if s.step_s is not None), None)
        if axis is None and step is not None:
            axis = Axis(scope.path or "grid", longest, step_s=step, unit="s")
        name = record.title or path
        if axis is None or axis.length not in (node.rows, node.columns):
            self.notes.append(f"no time of its length, so not read: {path} ({longest})")
            return
        stream = self._stream(axis, scope)
        side = 0 if node.rows == axis.length else 1
        count = node.columns if side == 0 else node.rows
        for i in range(count):
            stream.columns.append(
                Column(
                    name if count == 1 else f"{name}({i + 1})",
                    record.unit,
                    node.dtype,
                    axis.length,
                    partial(node.line, i, side),
                )
            )

    def _nothing(self, variables: Mapping[str, Node]) -> FormatError:
        shown = ", ".join(f"{k} ({_size(v)})" for k, v in list(variables.items())[:12]) or "nothing readable"
        if self.losses and all(isinstance(v, Odd | Text) for v in variables.values()):
            return FormatError(
                "no variable can be read",
                where=self.where,
                got=self.losses[0].reason.split(". ")[0],
                expected="vectors, matrices, structs, cells",
                hint=[*self.losses[0].reason.split(". "), "save the variables as plain vectors"][1],
            )
        return FormatError(
            "no time and signals found",
            where=self.where,
            got=shown,
            expected="a vector called t, time, Zeit, čas or 时间 as long as the signals; a matrix with "
            "its time in a column; structs with data and time, or dt",
            hint="declare table: {time: {column: NAME or number, unit: s}}, and sheet: VARIABLE to "
            "read one variable only",
        )


def _up(scope: Scope | None) -> Iterator[Scope]:
    while scope is not None:
        yield scope
        scope = scope.above


def _described(scope: Scope) -> dict[str, str]:
    """Scalars and texts of a scope, and of those above it."""
    found: dict[str, str] = {}
    for level in _up(scope):
        for key, value in level.properties.items():
            if value and len(found) < 100:
                found.setdefault(key, value)
    return found


def _fitting(scope: Scope, kind: str, count: int) -> list[str] | None:
    lists: list[Sequence[str]] = [x for s in _up(scope) for x in getattr(s, kind)]
    return next((list(x) for x in lists if len(x) == count), None)


def _rises(values: Array) -> bool:
    if values.dtype.kind not in "iuf" or values.size < 2:
        return False
    return bool(np.isfinite(values).all() and (values[1:] > values[:-1]).all())


def _same_axis(a: Axis, b: Axis) -> bool:
    if a is b:
        return True
    if (a.length, a.unit, a.texts, a.step_s, a.zero_s) != (b.length, b.unit, b.texts, b.step_s, b.zero_s):
        return False
    if a.load is None or b.load is None:
        return a.load is b.load
    return all(np.array_equal(a.load(i, i + 500_000), b.load(i, i + 500_000)) for i in range(0, a.length, 500_000))


def _last(path: str) -> str:
    return path.rsplit("/", 1)[-1]


def _part(words: Array, start: int, stop: int) -> Array:
    return words[start:stop]


def _size(node: Node) -> str:
    if isinstance(node, Numbers):
        return f"{node.rows}x{node.columns}"
    return node.kind if isinstance(node, Odd) else type(node).__name__.lower()
