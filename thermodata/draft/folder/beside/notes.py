"""What texts beside the logs, and the heads of these, say of single tests: 'run01: tool D50, no coolant' in notes.txt,
a row of a table in README.md, '# tool: HSK63' above the rows."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from thermodata.archive.unpacked import held
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.beside.statements import statements
from thermodata.draft.words.axis import axis_of
from thermodata.draft.words.naming import words
from thermodata.draft.words.said_by_names import said_by
from thermodata.draft.words.tool_and_coolant import tool_and_coolant, tool_and_coolant_of_head
from thermodata.draft.words.vocabulary import places_in, quantities_in
from thermodata.errors import FormatError
from thermodata.reader.text.cells.cell import is_number
from thermodata.reader.text.file.encoding import decode_head

_NOTES = frozenset({".txt", ".md", ".rst", ".log", ""})
_LARGEST, _HEAD, _MOST_LINES = 100_000, 4096, 40  # bytes of a text, of the head of a log; lines of a head
_SHOWN = 80
_CELLS = re.compile(r"[\t|;,]")
_NUMBERS = re.compile(r"^\d[\d._-]*[_\- .]")
_SHORT = re.compile(r"[^\W\d_]{1,12}\d+(?=[_\- .])")  # a word with its number, which more stands behind
_SHORTEST = 3  # letters of a name without its number
_AXES = frozenset({"axes", "achsen", "osy", "assi", "ejes", "eixos"})
_MARKS = " \t-*•#>"
_TAKEN = ("speed", "feed", "air")


@dataclass(frozen=True, slots=True)
class Note:
    """conditions: condition -> value with unit; file: where they stand; quoted: the words, '' where they are all told
    as conditions, as those of a head."""

    file: str
    conditions: Mapping[str, str] = field(default_factory=dict)
    quoted: str = ""

    def comment(self) -> str:
        return f"{self.file} says '{self.quoted}'" if self.quoted else ""


def notes_of(folder: Path, texts: Sequence[str], tests: Mapping[str, Sequence[RawFile]]) -> dict[str, Note]:
    """Test -> what is said of it. texts: files beside the logs, which no reader takes; of a test that several
    lines name nothing is taken from them."""
    found = _by_lines(folder, described_in(folder, texts), tests)
    for test, files in tests.items():
        if test in found:
            continue
        conditions = {k: v for f in reversed(files) for k, v in tool_and_coolant_of_head(_head(folder, f)).items()}
        if conditions:
            found[test] = Note(f"the head of {files[0].path.name}", conditions)
    return found


def _by_lines(folder: Path, texts: Sequence[str], tests: Mapping[str, Sequence[RawFile]]) -> dict[str, Note]:
    called = (
        _begins(tests)
        | _but_numbers(tests)
        | {name: test for test, files in tests.items() for name in _names(test, files)}
    )
    lines: dict[str, list[Note]] = {}
    shared: dict[str, list[Note]] = {}  # of lines that name several
    for path in texts:
        head: list[str] = []
        for line in _with_headings(text_of_notes(folder, path).splitlines(), called):
            if "|" not in line and (several := statements(line, called)):
                for name, told in several:
                    shared.setdefault(name, []).append(_note(path, told))
                continue
            cells = [c.strip() for c in line.strip(" |").split("|")] if "|" in line else []
            first, rest = _first(line) if len(cells) < 2 else (cells[0].casefold(), ", ".join(cells[1:]))
            test = called.get(first)
            if len(cells) > 1 and len(cells) == len(head) and test is not None:
                rest = ", ".join(f"{h} {c}" for h, c in zip(head[1:], cells[1:], strict=True) if c)
            head = cells if len(cells) > 1 and not head else head if len(cells) > 1 else []
            if test is not None and rest:
                lines.setdefault(test, []).append(_note(path, rest))
    alone, beside = ({t: n[0] for t, n in found.items() if len(n) == 1} for found in (lines, shared))
    for test in beside.keys() & lines.keys():
        own = alone.get(test)
        beside[test] = replace(own, quoted=f"{own.quoted}; {beside[test].quoted}") if own else beside[test]
    return alone | beside


def _note(path: str, said: str) -> Note:
    pieces = [p.strip() for p in re.split(r"[,;|\t]", said)]
    more = {k: v for k, v in said_by(pieces).conditions.items() if k in _TAKEN}
    return Note(path, {**more, **tool_and_coolant(pieces)}, said[:_SHOWN])


def text_of_notes(folder: Path, path: str) -> str:
    """What stands in a text that somebody may have written; '' of other files, and of large ones."""
    said = _read(folder / path, _LARGEST + 1) if PurePosixPath(path).suffix.lower() in _NOTES else ""
    return said if len(said) <= _LARGEST else ""


def described_in(folder: Path, texts: Sequence[str]) -> list[str]:
    """The texts in which somebody may have described the tests."""
    return [*sorted(p.name for p in folder.glob("*.md") if p.is_file() and not p.is_symlink()), *texts]


def _names(test: str, files: Sequence[RawFile]) -> set[str]:
    """What a line may begin with to be of a test."""
    own = {n.casefold() for f in files if len(files) == 1 for n in (f.path.name, f.path.stem)}
    return {test.casefold(), *own}


def _but_numbers(tests: Mapping[str, Sequence[RawFile]]) -> dict[str, str]:
    """What is called by a name that is a test's but for the day or number before it: '0812_dankai' alone is 'dankai'.
    A word of the trade is none: '01_feed' is no 'Feed: linear motors, dry'."""
    bare = {test: _NUMBERS.sub("", test).casefold() for test in tests}
    count = Counter(bare.values())
    return {
        name: test
        for test, name in bare.items()
        if count[name] == 1 and sum(map(str.isalpha, name)) >= _SHORTEST and not _is_of_trade(name)
    }


def _begins(tests: Mapping[str, Sequence[RawFile]]) -> dict[str, str]:
    """What a test is called for short, where no other begins so: 'V01' is 'V01_4000'."""
    each = [(match[0].casefold(), test) for test in tests if (match := _SHORT.match(test)) is not None]
    count = Counter(name for name, _ in each)
    return {name: test for name, test in each if count[name] == 1}


def _is_of_trade(name: str) -> bool:
    """Whether a name is one word for a part of a machine, an axis, a quantity or the coolant."""
    said = words(name)
    if said in _AXES or axis_of(said) or axis_of(f"{said} a"):
        return True
    return name.isalpha() and bool(places_in(said) or quantities_in(said) or tool_and_coolant([said]))


def _with_headings(lines: Sequence[str], called: Mapping[str, str]) -> list[str]:
    """The lines, what stands under the name of a test ('run01:', '## run01') in one with it, up to an empty line."""
    found: list[str] = []
    under, waits = False, False  # waits: nothing stands under a heading of Markdown yet, behind which lines are empty
    for line in lines:
        bare, (first, rest) = line.strip(), _first(line)
        if not bare:
            under = waits
        elif first in called or bare.startswith("#") or bare.endswith(":"):
            under = first in called and not rest and (bare.startswith("#") or bare.endswith(":"))
            waits = under and bare.startswith("#")
            found.append(f"{first}:" if under else line)
        elif under:
            found[-1] += f"{' ' if found[-1].endswith(':') else ', '}{bare.strip(_MARKS)}"
            waits = False
        else:
            found.append(line)
    return found


def _first(line: str) -> tuple[str, str]:
    """(the name that a line begins with, what follows it)."""
    bare = line.strip().strip(_MARKS)
    name, mark, rest = bare.partition(":")
    if not mark or re.search(r"\s", name.strip()):
        name, rest = (*re.split(r"[\s|;,]", bare, maxsplit=1), "")[:2]
    return name.strip(" '\"`").casefold(), rest.strip(" \t:=-|–")


def _head(folder: Path, file: RawFile) -> list[str]:
    """The lines of a text above its rows."""
    found: list[str] = []
    for line in _read(folder / file.path, _HEAD).splitlines()[:_MOST_LINES]:
        cells = [c.strip() for c in _CELLS.split(line) if c.strip()]
        if len(cells) > 2 and sum(is_number(c) for c in cells) * 2 > len(cells):
            break
        if len(cells) <= 2:  # 'tool: A', or 'tool;A'; a row of names has more
            found.append(line.strip().lstrip(_MARKS))
    return [line for line in found if re.search(r"[:=;,\t|]", line)]


def _read(path: Path, size: int) -> str:
    try:
        with held(path) as real, real.open("rb") as file:
            data = file.read(size)
    except (FormatError, OSError):
        return ""
    return decode_head(data) or ""
