"""Each variable by its role: a time, a signal, names, units, a property, or a struct to look into."""

from __future__ import annotations

from functools import partial

import numpy as np

from thermodata.plugin import Array, Loss
from thermodata.reader.text import split_unit
from thermodata.reader.text.preamble.scale_words import stated_of, states_scale
from thermodata.schema.units.unit import is_unit
from thermodata_reader_table.mat.planned import names as say
from thermodata_reader_table.mat.planned.signal_structs import one_number, one_text
from thermodata_reader_table.mat.planned.signal_structs import texts as lines_of
from thermodata_reader_table.mat.planned.stream_plan import (
    LOOK,
    MOST_SCALES,
    Column,
    Listed,
    Plan,
    Scope,
    TimeVector,
    rises,
)
from thermodata_reader_table.mat.tree import Cells, Node, Numbers, Odd, Struct, Structs, Text, refusal


def lose_object(plan: Plan, path: str, node: Odd) -> None:
    """A loss for an object of MATLAB's; functions are no data, and nothing is lost with them."""
    if node.kind != "function_handle":
        plan.losses.append(Loss(f"{plan.where} variable '{path}'", reason=refusal(node.kind)))


def sort_variable(plan: Plan, scope: Scope, name: str, node: Node, inner: list[tuple[str, Struct]]) -> None:
    """Puts a variable into its scope; structs go into `inner`, to be looked into afterwards."""
    path = f"{scope.path}/{name}" if scope.path else name
    if isinstance(node, Struct):
        words = {k: one_text(v) for k, v in node.fields.items()}
        if say.names_units(name) and all(words.values()):
            scope.unit_of |= {k: v for k, v in words.items() if v}
        else:
            inner.append((path, node))
    elif isinstance(node, Structs):
        inner.extend((f"{path}({i})", item) for i, item in enumerate(node.items, 1))
    elif isinstance(node, Odd):
        lose_object(plan, path, node)
    elif isinstance(node, Numbers):
        _numbers(plan, scope, name, path, node)
    else:
        _texts(plan, scope, name, path, node, inner)


def _numbers(plan: Plan, scope: Scope, name: str, path: str, node: Numbers) -> None:
    if node.size == 1:
        value = one_number(node)
        if value is not None and say.names_step(name) and value > 0:
            scope.step_s = value
        elif value and say.names_rate(name):
            scope.step_s = 1.0 / value
        scope.properties[name] = f"{value:.12g}"
        _state(plan, path, scope.properties[name])
    elif node.is_vector:
        if _is_time(plan, name, path, node):
            unit = split_unit(name)[1] or say.unit_in_name(name) or say.unit_among(node.said)
            scope.times.append(TimeVector(path, node.size, node.vector, unit=unit, said=node.said))
        else:
            scope.scales += _scales(scope, name, node)
            unit = split_unit(name)[1] or say.unit_among(node.said, is_unit)
            scope.columns.append(Column(path, unit, node.dtype, node.size, node.vector))
    elif node.size:
        scope.matrices.append((path, node))


def _state(plan: Plan, path: str, text: str) -> None:
    """Notes what a variable called after a signal states of its scale: 'dZ_gain', 'cal/dZ/gain'."""
    found = stated_of(path)
    if found is not None:
        name = path.rsplit("/", 1)[-1]
        key = name if stated_of(name) else path
        plan.stated.setdefault(found[0].casefold(), {}).setdefault(key, text)


def _scales(scope: Scope, name: str, node: Numbers) -> list[Listed]:
    """The factors or offsets of a matrix's columns that a short vector holds: 'gain', 'T_gain'."""
    found = stated_of(name)
    if node.size > MOST_SCALES or (found is None and not states_scale(name)):
        return []
    return [Listed(name, found[0] if found else "", tuple(f"{v:.12g}" for v in node.vector(0, node.size).tolist()))]


def _is_time(plan: Plan, name: str, path: str, node: Numbers) -> bool:
    if isinstance(plan.wanted, str):
        return plan.wanted in (path, name)
    if node.dtype == "bool":
        return False
    return say.names_time(name) or (say.may_be_time(name) and rises(node.vector(0, LOOK)))


def _texts(plan: Plan, scope: Scope, name: str, path: str, node: Text | Cells, inner: list[tuple[str, Struct]]) -> None:
    lines = lines_of(node)
    if lines is None:
        _cells(plan, scope, path, node, inner)
    elif len(lines) == 1:
        _one_text(plan, scope, name, path, lines[0])
    elif lines:
        _list_of_texts(plan, scope, name, path, lines)


def _one_text(plan: Plan, scope: Scope, name: str, path: str, text: str) -> None:
    """The unit of a column or of the time, a list of one name or unit; in any case a property of the file."""
    scope.properties[name] = text[:500]
    if (of := say.unit_of(name, scope.known, text)) is not None:
        scope.unit_of.setdefault(of, text)
        return
    if say.names_time_unit(name, text):
        scope.time_unit = text
    if say.names_units(name):
        scope.units.append(_list_of_variable(scope, name, [text]))
    elif say.names_names(name):
        scope.names.append(_list_of_variable(scope, name, [text]))
    _state(plan, path, scope.properties[name])


def _list_of_texts(plan: Plan, scope: Scope, name: str, path: str, lines: list[str]) -> None:
    """Units, times or names of columns, else a column of words."""
    if say.names_units(name) or say.unit_of(name, scope.known) in scope.known:
        scope.units.append(_list_of_variable(scope, name, lines))
    elif (say.names_time(name) and plan.wanted is None) or plan.wanted in (path, name):
        scope.times.append(TimeVector(path, len(lines), texts=tuple(lines)))
    elif say.names_names(name) or say.listed_of(name, scope.known) in scope.known:
        scope.names.append(_list_of_variable(scope, name, lines))
    else:
        scope.columns.append(Column(path, None, "str", len(lines), partial(_part, np.array(lines, object))))


def _list_of_variable(scope: Scope, name: str, lines: list[str]) -> Listed:
    return Listed(name, say.listed_of(name, scope.known), tuple(lines))


def _cells(plan: Plan, scope: Scope, path: str, node: Text | Cells, inner: list[tuple[str, Struct]]) -> None:
    items = node.items if isinstance(node, Cells) else ()
    if all(isinstance(item, Struct) for item in items):
        inner.extend((f"{path}{{{i}}}", item) for i, item in enumerate(items, 1) if isinstance(item, Struct))
    elif all(isinstance(item, Numbers) and item.is_vector for item in items):
        for i, item in enumerate(items, 1):
            assert isinstance(item, Numbers)
            scope.columns.append(Column(f"{path}{{{i}}}", None, item.dtype, item.size, item.vector))
    elif items:
        plan.losses.append(
            Loss(f"{plan.where} variable '{path}'", reason="a cell array of mixed content: save its columns as vectors")
        )


def _part(words: Array, start: int, stop: int) -> Array:
    return words[start:stop]
