"""A table or a list beside the logs, or a sheet among them, that says what their signals are: T01 is a bearing, in °C;
CH3 the tool along X."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from pathlib import Path

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.beside.lists_in_texts import bracketed, in_prose, listed, piped
from thermodata.draft.folder.beside.notes import described_in
from thermodata.draft.folder.beside.said_twice import begins_with_a_time, of_names
from thermodata.draft.folder.beside.table import LARGEST, SUFFIXES, WORKBOOKS, grids_of, readable
from thermodata.draft.folder.scan import Scan
from thermodata.draft.signals.guess import SENSOR
from thermodata.draft.words.filenames import normal
from thermodata.draft.words.naming import words as spelt
from thermodata.draft.words.vocabulary import places_in, quantities_in
from thermodata.errors import ThermodataError
from thermodata.plugin import Signal
from thermodata.reader.text import decode, split_unit
from thermodata.schema.agreed.exported import is_own_about, said_key
from thermodata.schema.units.unit import is_unit
from thermodata.schema.words.places import is_known
from thermodata.schema.words.sentences import with_count

IN_LEGEND = "described_in"  # the property of a signal that says where its description stands
TOLD_TOO = "described_there_too"  # that says what else stands there
_MOST_ROWS, _FEWEST, _SHORTEST = 400, 3, 3
_TEXTS = (".md", ".rst", "")
_SHOWN = 4
_EAST_ASIA = 0x2E80
_OWN = ("quantity", "axis", "at", "sign")
_ONCE = 3  # of so many names one may be named again: a list of what happened names most
_AXES = frozenset("XYZUVWABC")
_EITHER = frozenset("ABC")
_AXIS = re.compile(r"^(?P<text>.*?)[\s,;]+(?:(?:axis|achse|osa|axe|asse|eje)\s+)?(?P<axis>[XYZ])$", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class LegendEntry:
    """Of a signal. name: as it stands there; text: what it is; unit, axis, at: None where nothing is said. own:
    key of the table `channel` -> what a workbook of our own says. others: what more lines say of it that is something
    else."""

    name: str
    text: str
    unit: str | None = None
    axis: str | None = None
    others: tuple[str, ...] = ()
    own: Mapping[str, str] = field(default_factory=dict)
    at: str | None = None

    @property
    def described(self) -> str:
        """The words to guess by, the axis among them."""
        return f"{self.text} {self.axis}" if self.axis and not _names_axis(self.text, self.axis) else self.text


@dataclass(frozen=True, slots=True)
class Legend:
    """file: its path; says: the last word of a signal's name, in lower case -> what it says of it."""

    file: str
    says: Mapping[str, LegendEntry]

    def note(self) -> str:
        said = [f"{s.name} is '{s.described}'" + (f" in {s.unit}" if s.unit else "") for s in self.says.values()]
        return f"{self.file} says what signals are: {with_count(said, _SHOWN)}"


def with_legends(folder: Path, found: Scan) -> tuple[Scan, list[str]]:
    """The logs, their signals described by the first table that names them; and a note on it. A description that stands
    in a log itself counts more. What a workbook of our own says is of its own sheets."""
    names = {word_of(s.name) for f in found.logs for s in f.signals}
    names |= {s.properties[SENSOR].casefold() for f in found.logs for s in f.signals if SENSOR in s.properties}
    # a file of one signal may be called as that is, and one of a sensor as the sensor
    logs_of_many = [f for f in found.logs if len(f.signals) > 1 and f.sensor is None]
    tests = {normal(t) for f in logs_of_many for t in (f.path.stem, *f.path.parts[:-1], f.sheet or "")}
    books = [str(f.path) for f in found.logs if f.path.suffix.lower() in WORKBOOKS]
    own: dict[str, Legend] = {}
    for file in dict.fromkeys((*found.others, *described_in(folder, ()), *books)):
        path = readable(folder / file)
        if path is None or path.suffix.lower() not in (*SUFFIXES, *_TEXTS) or path.stat().st_size > LARGEST:
            continue
        lists = [] if path.suffix.lower() in WORKBOOKS else _lists_of(path, names)
        grids = () if path.suffix.lower() in _TEXTS else grids_of(path, _MOST_ROWS)
        for rows in (*grids, *lists):
            if (legend := _legend(file, rows, names, tests)) is not None:
                if file in books and any(s.own for s in legend.says.values()):
                    own[file] = legend
                    break
                logs = tuple(described_by(f, legend) for f in found.logs)
                left = tuple(x for x in found.ignored if x[0] != file)
                return replace(found, logs=logs, ignored=left), [legend.note()]
    if not own:
        return found, []
    logs = tuple(described_by(f, own[str(f.path)]) if str(f.path) in own else f for f in found.logs)
    return replace(found, logs=logs), [next(iter(own.values())).note()]


def word_of(name: str) -> str:
    """The last word of a name, in lower case: 't01' of 'Temp/T01 [°C]', and of 'ns=3;s="DB_Thermo"."T01"'."""
    found: list[str] = re.findall(r"\w+", split_unit(name)[0].casefold())
    return found[-1] if found else ""


def _legend(file: str, rows: Sequence[Sequence[str]], names: set[str], tests: Set[str]) -> Legend | None:
    """One row a signal: its name in one column, words in another. Where these are the names of the tests too, it says
    what those are."""
    full = [r for r in rows if sum(map(bool, r)) >= 2]
    if (heads := next((r for r in full if is_own_about(r)), None)) is not None:
        return Legend(file, _of_our_own(heads, [r for r in full if r[0].casefold() in names]))
    for key in range(max(map(len, full), default=0)):
        own = [r for r in full if key < len(r)]
        named = [r for r in own if r[key].casefold() in names]
        among = [r for r in own if r in named or not (normal(r[key]) in tests or any(map(begins_with_a_time, r)))]
        words = {r[key].casefold() for r in named}
        again = {w for w, n in Counter(r[key].casefold() for r in named).items() if n > 1}
        # a list of one or two says what signals are where it has nothing but these, and they are known parts: no names
        # of other signals, as the head of a log has
        few = len(words) < _FEWEST and len(among) - len(named) <= 1
        least = 1 if few else _FEWEST
        if len(words) < max(least, (len(among) - 1) / 2) or len(again) * _ONCE > len(words):
            continue
        if all(normal(r[key]) in tests for r in named):
            continue
        for column in range(max(map(len, named))):
            said = of_names([(r[key], r[column]) for r in named if column < len(r)], _is_words)
            if few and not all(_is_part(one.text) and word_of(one.text) not in names for one in said.values()):
                continue
            if column != key and len(said) >= least and len({s.text for s in said.values()}) * 2 > len(said):
                beside = [c for c in range(max(map(len, named))) if c not in (key, column)]
                units, axes = _column(named, key, beside, _is_unit), _column(named, key, beside, _AXES.__contains__)
                found = {word: replace(_parted(of.name, of.text), others=of.others) for word, of in said.items()}
                places = _column(named, key, beside, _is_place)
                return Legend(
                    file,
                    {
                        word: replace(
                            one, unit=one.unit or units.get(word), axis=one.axis or axes.get(word), at=places.get(word)
                        )
                        for word, one in found.items()
                    },
                )
    return None


def _of_our_own(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> dict[str, LegendEntry]:
    """What a workbook of our own says, each cell under its head: the units are those of its columns, not of the log
    that these came from."""
    found: dict[str, LegendEntry] = {}
    for row in rows:
        told = {head: cell for head, cell in zip(heads, row, strict=False) if cell}
        name, unit = told["channel"], told.get("unit")
        text = split_unit(told.get("signal", name))[0]
        own = {key: told[key] for key in _OWN if key in told}
        found[name.casefold()] = LegendEntry(name, text, None if unit == "1" else unit, told.get("axis"), own=own)
    return found


def _column(
    rows: Sequence[Sequence[str]], key: int, columns: Sequence[int], are: Callable[[str], bool]
) -> dict[str, str]:
    """What the first column says whose filled cells all are of a kind, some of them more than a letter that may be of
    another: a unit A, an axis A."""
    for column in columns:
        found = {r[key].casefold(): r[column] for r in rows if column < len(r) and r[column] not in ("", "-")}
        if found and all(map(are, found.values())) and not set(found.values()) <= _EITHER:
            return found
    return {}


def _parted(name: str, text: str) -> LegendEntry:
    """'displacement TCP [um], X' in its parts."""
    bare, unit = split_unit(text)
    axis = _AXIS.match(bare) if unit is not None else None
    if unit is None and (found := _AXIS.match(text)) and (inner := split_unit(found["text"].rstrip(", ")))[1]:
        bare, unit, axis = inner[0], inner[1], found
    letter = axis["axis"].upper() if axis is not None else None
    return LegendEntry(
        name, (axis["text"] if axis is not None and bare == axis.string else bare).strip(" ,;"), unit, letter
    )


def _names_axis(text: str, axis: str) -> bool:
    return re.search(rf"(?<![^\W\d_]){axis}(?![^\W\d_])", text) is not None


def _lists_of(path: Path, names: Set[str]) -> list[list[list[str]]]:
    """What a text says of signals that are called so, as rows: each way to read it."""
    try:
        text, _, _ = decode(path.read_bytes())
    except (ThermodataError, OSError):
        return []
    lines = [line.strip() for line in text.splitlines()]
    return [
        piped(lines, _MOST_ROWS),
        bracketed(lines, _MOST_ROWS),
        listed(lines, _MOST_ROWS),
        in_prose(lines[:_MOST_ROWS], names),
    ]


def _is_unit(cell: str) -> bool:
    return is_unit(cell) and not cell.isdecimal()


def _is_place(cell: str) -> bool:
    return is_known(cell)


def _is_words(cell: str) -> bool:
    # a sign of East Asia is a word, or half of one
    letters = sum(2 if ord(c) >= _EAST_ASIA else 1 for c in cell if c.isalpha())
    return letters >= _SHORTEST and not is_unit(cell)


def _is_part(text: str) -> bool:
    """Whether words name a part of a machine or its surroundings, or what is measured."""
    said = spelt(text)
    return bool(places_in(said) or quantities_in(said))


def described_by(file: RawFile, legend: Legend) -> RawFile:
    """The file, its signals described by a legend where it does not describe them itself."""

    def told(signal: Signal) -> Signal:
        sensor = signal.properties.get(SENSOR, "").casefold()  # of which the file is, whatever it calls its values
        said = legend.says.get(sensor) if sensor in legend.says else legend.says.get(word_of(signal.name))
        if said is None or signal.properties.get("description"):
            return signal
        of = {**signal.properties, "description": said.described, IN_LEGEND: legend.file}
        of |= {said_key(signal.name, key): text for key, text in said.own.items()}
        of |= {said_key(signal.name, "at"): said.at} if said.at else {}
        of |= {TOLD_TOO: "', '".join(said.others)} if said.others else {}
        # words of a switch have none, and what the log says of its numbers counts more
        return replace(signal, properties=of, unit=signal.unit or (said.unit if signal.dtype != "str" else None))

    return replace(file, recording=replace(file.recording, signals=tuple(map(told, file.signals))))
