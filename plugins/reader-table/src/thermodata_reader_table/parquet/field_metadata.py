"""What the metadata of a Parquet file say of its columns: those of a column itself, and those of the file that name
one, as pandas keeps `attrs`."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from thermodata.reader.text import split_unit
from thermodata.reader.text.preamble.scale_words import spellings, stated_of
from thermodata.schema.units.unit import normal_unit

_UNIT = ("unit", "units", "einheit")
_OF_ARROW = ("PARQUET:", "ARROW:")
_LONGEST, _MOST, _DEEPEST = 200, 100, 6


def said_of_fields(schema: Any, of_file: Mapping[bytes, bytes] | None) -> list[dict[str, str]]:
    """Of each column what its metadata say, {'unit': 'um', 'scale_factor': '0.1'}, and what those of the file state of
    its unit and scale."""
    stated: dict[str, dict[str, str]] = {}
    for key, text in _texts(of_file):
        for path, value in _leaves(key, text):
            found = stated_of(path) or _unit_of(path)
            if found is not None:
                told = "unit" if found[1].casefold() in _UNIT else "/".join(path.split("/")[-2:])
                stated.setdefault(found[0].casefold(), {}).setdefault(told, value)
    said = []
    for field in schema:
        of_column = {k: v for name in spellings(str(field.name)) for k, v in stated.get(name, {}).items()}
        own = dict(list(_texts(field.metadata))[:_MOST])
        said.append({**of_column, **own})
    return said


def said_of_file(metadata: Mapping[bytes, bytes] | None, names: Sequence[str]) -> dict[str, str]:
    """What the metadata of the file say, and not of one of its columns."""
    columns, said = set(names), dict[str, str]()
    for key, text in _texts(metadata):
        for path, value in _leaves(key, text):
            if columns.isdisjoint(path.split("/")) and len(said) < _MOST:
                said.setdefault(path.split("/")[-1], value)
    return said


def _unit_of(path: str) -> tuple[str, str] | None:
    """('dZ', 'units') of 'units/dZ' and of 'dZ/units'; None of another path."""
    *_, above, last = "", *path.split("/")
    pair = (above, last) if last.casefold() in _UNIT else (last, above)
    return pair if pair[1].casefold() in _UNIT and pair[0] else None


def units_of(names: Sequence[str], said: Sequence[Mapping[str, str]]) -> tuple[list[str | None], list[str]]:
    """The unit of each column: in its name, or in its metadata; and a note on those that say two."""
    units, notes = list[str | None](), list[str]()
    for name, own in zip(names, said, strict=True):
        low = {k.casefold(): v.strip() for k, v in own.items()}
        told = next((low[key] for key in _UNIT if low.get(key)), None)
        written = split_unit(name)[1]
        if told and written and normal_unit(told) != normal_unit(written):
            notes.append(f"'{name}': its metadata say '{told}', which is not used: is it in '{written}'?")
        units.append(written or told)
    return units, notes


def _texts(metadata: Mapping[bytes, bytes] | None) -> Iterator[tuple[str, str]]:
    for key, text in (metadata or {}).items():
        name = key.decode("utf-8", "replace")
        if not name.startswith(_OF_ARROW):
            yield name, text.decode("utf-8", "replace")


def _leaves(key: str, text: str) -> Iterator[tuple[str, str]]:
    """The path and text of each value of a JSON object, or of a plain text."""
    try:
        tree = json.loads(text) if text.lstrip().startswith("{") else text
    except (ValueError, RecursionError):
        return
    yield from _texts_below(key, tree, 0)


def _texts_below(path: str, node: Any, depth: int) -> Iterator[tuple[str, str]]:
    if isinstance(node, Mapping):
        for key, inner in node.items() if depth < _DEEPEST else ():
            yield from _texts_below(f"{path}/{key}", inner, depth + 1)
    elif isinstance(node, str | int | float) and len(str(node)) <= _LONGEST:
        yield path, str(node)
