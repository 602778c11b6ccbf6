"""A table of tests beside the files: which of its columns names the test, and what conditions it gives."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from pathlib import Path, PurePath
from typing import Any

from thermodata.archive.unpacked import unpacked
from thermodata.archive.workbook import check_size
from thermodata.draft.folder.beside.listed_times import ListedTime, listed_times
from thermodata.draft.signals.units import quantities_of
from thermodata.draft.words.filenames import normal
from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.naming import plain, words
from thermodata.draft.words.vocabulary import quantities_in
from thermodata.errors import FormatError, ThermodataError
from thermodata.reader.text import decode, split_unit

LARGEST = 4_000_000
_ROWS_A_TEST = 4  # a table of tests has about a row a test; what has hundreds of rows for a few tests is a log
WORKBOOKS = (".xlsx", ".xlsm")
SUFFIXES = (".csv", ".txt", ".tsv", *WORKBOOKS)
INSTALL = "pip install 'thermodata[workbook]'"
_NAMED = (
    "test tests versuch zkousk mereni plan protocol protokoll matrix 试验 测试 实验 runs uebersicht ubersicht overview"
)
_KNOWN = (
    ("speed", "speed. drehzahl otack rpm. 转速 n. s."),
    ("feed", "feed. vorschub posuv 进给 f. vf."),
    ("air", "air. luft. vzduch 气"),
    ("tool", "tool. werkzeug nastroj 刀具"),
    ("axis", "axis. achse. osa. 轴"),
)
_QUANTITIES = (("speed", "rotational_speed"), ("feed", "feed"))


@dataclass(frozen=True, slots=True)
class TestTable:
    """file: its path; key: its column that names the tests; rows: test -> condition -> value with unit; times: test ->
    when it began and ended, where the table says it."""

    __test__ = False
    file: str
    key: str
    rows: Mapping[str, Mapping[str, str]]
    times: Mapping[str, ListedTime] = field(default_factory=dict)


def find_table(
    folder: Path, candidates: Sequence[str], tests: Sequence[str], by_number: bool = True
) -> TestTable | None:
    """The first small table in which most tests are named, each once; None where there is none. by_number: by the
    number at the end of their names too."""
    if not tests:
        return None
    tables = [c for c in candidates if Path(c).suffix.lower() in SUFFIXES]
    tables.sort(key=lambda c: (not holds_word(_NAMED, words(Path(c).stem)), c))
    most = most_rows(len(tests))
    for candidate in tables[:20]:
        path = readable(folder / candidate)
        if path is None or path.stat().st_size > LARGEST:
            continue
        for rows in grids_of(path, most, {normal(t) for t in tests}):
            found = _read(candidate, rows, tests, by_number)
            if found is not None:
                return found
    return None


def readable(path: Path) -> Path | None:
    """Where a file can be read; None where it is packed and can't be."""
    try:
        return unpacked(path)
    except FormatError:
        return None


def most_rows(tests: int) -> int:
    """How many rows a table of so many tests has at most; what has more is a log, whatever it is called."""
    return max(200, _ROWS_A_TEST * tests)


def is_called_table(path: str) -> bool:
    """Whether a name says table of tests."""
    return Path(path).suffix.lower() in SUFFIXES and holds_word(_NAMED, words(Path(path).stem))


def closed_workbooks(paths: Sequence[str]) -> list[str]:
    """A note on each workbook that is called a table of tests, where nothing is installed that opens it."""
    called = [p for p in paths if Path(p).suffix.lower() in WORKBOOKS and is_called_table(p)]
    if not called or _opens_workbooks():
        return []
    return [
        f"{p} was not opened, though its name says that it is a table of tests: workbooks need python-calamine, "
        f"which is not installed; try: {INSTALL}"
        for p in called
    ]


def _opens_workbooks() -> bool:
    try:
        import python_calamine  # noqa: F401
    except ImportError:
        return False
    return True


def grids_of(path: Path, most: int, tests: Set[str] = frozenset()) -> Iterator[list[list[str]]]:
    """The rows of a table as text, where it has at most so many; of a workbook, of each sheet that is no test and
    that somebody shows."""
    if path.suffix.lower() in WORKBOOKS:
        try:
            from python_calamine import SheetVisibleEnum, load_workbook

            check_size(path)
            book = load_workbook(str(path))
            shown = [s.name for s in book.sheets_metadata if s.visible == SheetVisibleEnum.Visible]
            for name in [n for n in shown if normal(n) not in tests][:5]:
                rows = book.get_sheet_by_name(name).to_python()
                if len(rows) <= most:
                    yield [[_text(c) for c in row] for row in rows]
        except Exception:  # a workbook may be broken in any way; then it is no table of tests
            return
        return
    try:
        data = path.read_bytes()
        if max(data.count(b"\n"), data.count(b"\r")) > most:
            return
        text, _, _ = decode(data)
    except (ThermodataError, OSError):
        return
    first = text.split("\n", 1)[0]
    delimiter = max(";\t,", key=first.count)
    if not first.count(delimiter):
        return
    try:
        found = [[c.strip() for c in row] for row in csv.reader(text.splitlines(), delimiter=delimiter)]
    except csv.Error:  # a cell of more than 128 KiB: nobody wrote that table by hand
        return
    yield found


def _text(cell: Any) -> str:
    return f"{cell:.15g}" if isinstance(cell, float) else "" if cell is None else str(cell).strip()


def _read(file: str, rows: list[list[str]], tests: Sequence[str], by_number: bool) -> TestTable | None:
    body = [r for r in rows if sum(map(bool, r)) >= 2]
    if len(body) < 2:
        return None
    header, lines = body[0], body[1:]
    wanted = {normal(t): t for t in tests}
    beginnings, numbers = _beginnings(tests), _numbers(tests) if by_number else {}
    best: tuple[int, int, dict[int, str]] | None = None
    for column in range(len(header)):
        keys = [normal(_stem(r[column])) if column < len(r) else "" for r in lines]
        for lookup in (wanted, beginnings, numbers):
            named = {i: lookup[k] for i, k in enumerate(keys) if k in lookup}
            if len(set(named.values())) == len(named) and (best is None or len(named) > best[0]):
                best = (len(named), column, named)
    if best is None or best[0] < max(2, 0.6 * len(tests)):
        return None
    _, key_column, named = best
    if _are_subtotals([r[key_column] if key_column < len(r) else "" for r in lines], named):
        return None
    found: dict[str, dict[str, str]] = {}
    conditions = _conditions([title if c != key_column else "" for c, title in enumerate(header)])
    for i, test in named.items():
        found[test] = {
            name: value
            for c, name in conditions.items()
            if c < len(lines[i]) and (value := _with_unit(lines[i][c], header[c], name))
        }
    times = listed_times(file, header, {test: lines[i] for i, test in named.items()})
    return TestTable(file, header[key_column], found, times)


def _are_subtotals(keys: Sequence[str], named: Mapping[int, str]) -> bool:
    """Whether the tests of a table have rows of their own sums below them ('T1', then 'T1 Total'): what is summed up
    there is measured, and no condition of a test. keys: the cells that name the rows; named: row -> test."""
    summed = sum(any(k.startswith(f"{keys[i]} ") for k in keys[i + 1 :]) for i in named)
    return 2 * summed > len(named)


def _stem(cell: str) -> str:
    """The name in a cell that holds a file's; a number stays as it is."""
    return PurePath(cell).stem if "." in cell and not cell[-1:].isdigit() else cell


def _beginnings(tests: Sequence[str]) -> dict[str, str]:
    """What the names of tests begin with, where that is of one alone and no number: 'T1' -> 'T1_servo'."""
    of: dict[str, set[str]] = {}
    for test in tests:
        for end in re.finditer(r"(?<=[^\W_])[_\W]", test):
            of.setdefault(normal(test[: end.start()]), set()).add(test)
    names = {normal(t) for t in tests}
    found = {n: next(iter(own)) for n, own in of.items() if len(own) == 1 and n not in names and not n.isdigit()}
    return found if len(set(found.values())) == len(tests) else {}


def _numbers(tests: Sequence[str]) -> dict[str, str]:
    """The number at the end of each test's name, where these differ: '7' -> 'S8000_F12_7'."""
    ends = {t: m[1] for t in tests if (m := re.search(r"(\d+)$", t))}
    found = {normal(n): t for t, n in ends.items()}
    return found if len(found) == len(tests) else {}


def _conditions(header: Sequence[str]) -> dict[int, str]:
    """Column -> condition, of those with a title. What has a name of its own has it once: of a second speed, its own
    words tell which it is."""
    found: dict[int, str] = {}
    for column, title in enumerate(header):
        known = _known(title)
        plainly = re.sub(r"__+", "_", plain(split_unit(title)[0])).lower()[:40]
        name = known if known and known not in found.values() else plainly
        if name:
            found[column] = name
    return found


def _known(title: str) -> str | None:
    """The condition that a title says, in any language; turns a minute are a speed, whatever they are called."""
    text, unit = split_unit(title)
    said = words(text)
    known = next((name for name, listed in _KNOWN if holds_word(listed, said)), None)
    if known is None and unit is not None and quantities_of(unit)[:1] == ("rotational_speed",):
        return "speed"
    return known or next((name for name, quantity in _QUANTITIES if quantities_in(said) == (quantity,)), None)


def _with_unit(cell: str, title: str, name: str) -> str:
    cell = cell.strip()
    number = re.fullmatch(r"[+-]?\d+(?:[.,]\d+)?", cell)
    if not number:
        return cell
    unit = split_unit(title)[1] or ("rpm" if name == "speed" else "")
    return f"{float(cell.replace(',', '.')):.15g} {unit}".strip()
