"""Files that describe the sensors key by key: 'sensors.yaml', 'channels.json', 'sensors.csv', as a mapping by names or
as a list of mappings. What they say of a signal is guessed by, as a legend is."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from thermodata.draft.folder.beside.legend import Legend, LegendEntry, described_by, word_of
from thermodata.draft.folder.beside.table import grids_of, readable
from thermodata.draft.folder.scan import Scan
from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.naming import words
from thermodata.errors import ThermodataError
from thermodata.reader.text import decode, split_unit
from thermodata.schema.strict.lines import parse_document
from thermodata.schema.units.unit import is_unit

_LARGEST, _MOST_ROWS, _DEEPEST, _LONGEST = 200_000, 400, 4, 200
_YAML, _TABLES = (".yaml", ".yml"), (".csv", ".tsv", ".txt", ".xlsx", ".xlsm")
_FILES = (
    "sensor signal channel kanal kanaele messstelle fuhler capteur sensore canale canal snimac cidla cidlo 传感器 信号 "
    "センサ"
)
_LETTERS = frozenset("XYZABC")
_NAME = (
    "name. signal. channel. tag. id. sensor. kanal. column. spalte. signalname. kanalname. canal. capteur. sloupec. "
    "名称 通道 信号"
)
_UNIT = "unit. units. uom. einheit. jednotka. unite. unita. unidad. 单位 単位"
_AXIS = "axis. achse. osa. axe. asse. eje. direction. richtung. 轴 軸"
_TEXT = (
    "description. desc. label. title. place. at. where. location. position. mounted. part. quantity. measures. type. "
    "kind. comment. beschreibung. bezeichnung. ort. messort. messstelle. stelle. groesse. grosse. bemerkung. popis. "
    "misto. umisteni. velicina. endroit. emplacement. lieu. grandeur. luogo. posizione. grandezza. lugar. magnitud. "
    "位置 描述 物理量 说明 場所 説明"
)


def with_sensors_described(folder: Path, found: Scan) -> tuple[Scan, list[str]]:
    """The logs, their signals described by each such file that names some of them; and a note on it. What stands in a
    log itself, and in the file before, counts more."""
    notes = []
    names = {word for f in found.logs for s in f.signals for word in (word_of(s.name), _bare(s.name))}
    for file in dict.fromkeys(path for path, _ in found.ignored):
        legend = Legend(file, _said_in(folder / file, names))
        if not legend.says:
            continue
        logs = tuple(described_by(f, legend) for f in found.logs)
        ignored = tuple(x for x in found.ignored if x[0] != file)
        others = tuple(p for p in found.others if p != file)
        found = replace(found, logs=logs, ignored=ignored, others=others)
        notes.append(legend.note())
    return found, notes


def _bare(name: str) -> str:
    return split_unit(name)[0].casefold()


def _said_in(path: Path, names: set[str]) -> dict[str, LegendEntry]:
    """The last word of a signal's name -> what a file says of it; nothing of what two entries of that word say."""
    found: dict[str, LegendEntry] = {}
    twice: set[str] = set()
    for name, entry in _entries(_document(path), 0):
        word = word_of(name)
        if _bare(name) not in names or (said := _said(name, entry)) is None:
            continue
        if found.setdefault(word, said) != said:
            twice.add(word)
    return {word: said for word, said in found.items() if word not in twice}


def _document(path: Path) -> Any:
    """What a file holds, as mappings, lists and plain values; None where it can't be read or is no such file."""
    suffix = path.suffix.lower()
    called = suffix in _YAML or holds_word(_FILES, words(path.stem))
    own = readable(path) if called and suffix in (*_YAML, ".json", *_TABLES) else None
    try:
        if own is None or own.stat().st_size > _LARGEST:
            return None
        if suffix in _TABLES:
            return [one for rows in grids_of(own, _MOST_ROWS) for one in _rows(rows)]
        text, _, _ = decode(own.read_bytes())
        if suffix == ".json":
            return json.loads(text)
        lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith(("#", "---"))]
        if lines and lines[0].startswith("- "):
            text = "sensors:\n" + "\n".join(line for line in text.splitlines() if not line.startswith("---"))
        return parse_document(text, path).data
    except (ThermodataError, OSError, ValueError, RecursionError):
        return None


def _rows(rows: Sequence[Sequence[str]]) -> Iterator[dict[str, str]]:
    """The rows of a table whose heads are keys."""
    full = [r for r in rows if sum(map(bool, r)) >= 2]
    heads = full[0] if full else ()
    if any(_is(_NAME, h) for h in heads) and any(_is(f"{_UNIT} {_TEXT}", h) for h in heads):
        yield from (dict(zip(heads, row, strict=False)) for row in full[1:])


def _entries(data: Any, depth: int) -> Iterator[tuple[str, Any]]:
    """(name, what is said of it) of all entries, those in groups too: 'sensors: {temperature: {T01: ...}}'."""
    if depth > _DEEPEST:
        return
    if isinstance(data, Mapping):
        for key, value in data.items():
            yield str(key), value
            yield from _entries(value, depth + 1)
    elif isinstance(data, list):
        for one in data:
            named = next((str(v) for k, v in one.items() if _is(_NAME, k)), None) if isinstance(one, Mapping) else None
            if named is not None:
                yield named, {k: v for k, v in one.items() if str(v) != named}


def _said(name: str, entry: Any) -> LegendEntry | None:
    """What an entry says of a signal: a text, or keys and their values; None where it says nothing."""
    if isinstance(entry, str):
        text, unit = split_unit(entry[:_LONGEST])
        return LegendEntry(name, text, unit) if any(map(str.isalpha, text)) else None
    if not isinstance(entry, Mapping):
        return None
    told = {str(k): v.strip()[:_LONGEST] for k, v in entry.items() if isinstance(v, str) and v.strip()}
    unit = next((v for k, v in told.items() if _is(_UNIT, k) and is_unit(v)), None)
    axes = (v.strip("+-").upper() for k, v in told.items() if _is(_AXIS, k))
    axis = next((letter for letter in axes if letter in _LETTERS), None)
    # a name within an entry that has its own is a description
    texts = [v for k, v in told.items() if _is(f"{_TEXT} {_NAME}", k) and not _is(_UNIT, k)]
    if not (texts or unit or axis):
        return None
    return LegendEntry(name, ", ".join(dict.fromkeys(texts)) or split_unit(name)[0], unit, axis)


def _is(listed: str, key: object) -> bool:
    return holds_word(listed, words(str(key)))
