"""Lists of the tests that a reader takes for a log, because they have dates: a row a test, with its name, when it began
and ended, its role, a remark."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

from thermodata.draft.folder.beside.listed_times import BEGIN, DURATION, END, ListedTime, listed_times
from thermodata.draft.folder.beside.table import SUFFIXES, grids_of, is_called_table, readable
from thermodata.draft.folder.scan import Scan
from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.naming import words
from thermodata.errors import FormatError
from thermodata.reader.text import split_unit
from thermodata.reader.text.cells.time_forms.clock_pattern import says_the_hour
from thermodata.reader.text.cells.time_forms.time_pattern import DATETIME, is_date_text, is_time_of_day
from thermodata.reader.text.times.one_cell import timestamp
from thermodata.reader.text.times.time_formats import find_format
from thermodata.reader.times.zone import NAT
from thermodata.schema.words.sentences import with_count

_KEY = (
    "test. test~id versuch. versuchs~nr run. lauf. nr. no. num. id. name. bezeichnung. essai. numero. proef. meting. "
    "messung. mereni. zkouska. prova. ensayo. 编号 序号 试验 测试 实验 名称 番号 試験 測定 実験"
)
_ROLE = (
    "role. rolle. rol. use. purpose. zweck. verwendung. usage. utilisation. but. objet. doel. gebruik. remark. "
    "remarks. comment. comments. note. notes. bemerkung. kommentar. remarque. commentaire. opmerking. "
    "opmerkingen. poznamka. "
    "用途 目的 备注 備考 役割 注释 说明 メモ"
)
_CALLED = "plan list. liste. lijst. proeven essais versuche uebersicht protokol 记录 計画 计划 一覧 清单 記録 リスト"
_MOST_ROWS, _LEAST_SAID, _SHOWN = 100, 2, 4
_STEADY_ROWS, _MEASURED_ROWS, _NEARLY = 5, 24, 0.9
_LONGEST_STEP = 900 * 10**9  # [ns] of a log so short; tests begin farther from each other
_DECIMAL = re.compile(r"[+-]?\d+[.,]\d+")


def lists_apart(folder: Path, found: Scan) -> Scan:
    """What was found, with the lists of tests among the others, and no longer among the logs."""
    lists = {str(f.path): names for f in found.logs if f.part is None and (names := listed_tests(folder, str(f.path)))}
    kept = tuple(f for f in found.logs if str(f.path) not in lists)
    why = tuple((path, _why(names)) for path, names in lists.items())
    return replace(found, logs=kept, others=(*found.others, *lists), ignored=(*found.ignored, *why))


def _why(names: Sequence[str]) -> str:
    shown = with_count([f"'{n}'" for n in names], _SHOWN)
    return f"a list of tests ({shown}), and no log; no test here is called so"


def listed_tests(folder: Path, path: str) -> list[str]:
    """The tests that a file lists, in its order; empty where it is no list."""
    return _list_in(folder, path)[0]


def times_listed(folder: Path, path: str) -> dict[str, ListedTime]:
    """Test -> when it began and ended, in the order of a list; empty where a file is no list of tests, or says no
    times."""
    names, header, lines = _list_in(folder, path)
    return listed_times(path, header, dict(zip(names, lines, strict=True))) if names else {}


def _list_in(folder: Path, path: str) -> tuple[list[str], Sequence[str], Sequence[Sequence[str]]]:
    """(the tests that a file lists, its header, a row each)"""
    own = readable(folder / path) if Path(path).suffix.lower() in SUFFIXES else None
    grids = list(grids_of(own, _MOST_ROWS)) if own is not None else []
    for rows in grids:
        body = [r for r in rows if sum(map(bool, r)) >= 2]
        if len(body) >= 2 and (names := _named(body[0], body[1:], path)):
            return names, body[0], body[1:]
    return [], (), ()


def _named(header: Sequence[str], lines: Sequence[Sequence[str]], path: str) -> list[str]:
    titles = [words(split_unit(t)[0]) for t in header]
    column = next(
        (i for i, t in enumerate(titles) if holds_word(_KEY, t) and not holds_word(f"{BEGIN} {END} {DURATION}", t)),
        None,
    )
    if column is None:
        return []
    names = [line[column].strip() if column < len(line) else "" for line in lines]
    if not all(names) or len(set(names)) < len(names) or _is_logged(header, lines):
        return []
    begins = any(holds_word(BEGIN, t) for t in titles) and any(holds_word(f"{END} {DURATION}", t) for t in titles)
    role = any(holds_word(_ROLE, t) for t in titles)
    called = is_called_table(path) or holds_word(_CALLED, words(Path(path).stem))
    # rows that are numbered may be means of a log, from one time to the next
    counted = all(n.isdigit() for n in names)
    said = sum((begins, role, called))
    return names if said >= _LEAST_SAID and (role or not counted) else []


def _is_logged(header: Sequence[str], lines: Sequence[Sequence[str]]) -> bool:
    """Whether rows go on as a log does: a time in them by short steps that are all alike, or, in a list too long to be
    written by hand, decimals under a unit."""
    columns = [[line[i].strip() if i < len(line) else "" for line in lines] for i in range(len(header))]
    if len(lines) >= _STEADY_ROWS and any(map(_is_steady, columns)):
        return True
    return len(lines) >= _MEASURED_ROWS and any(
        split_unit(title)[1] and sum(bool(_DECIMAL.fullmatch(c)) for c in column) >= _NEARLY * len(lines)
        for title, column in zip(header, columns, strict=True)
    )


def _is_steady(cells: Sequence[str]) -> bool:
    """Whether times go on by steps that are nearly all alike, and shorter than from test to test."""
    if not all((is_date_text(c) and says_the_hour(c)) or is_time_of_day(c) for c in cells):
        return False
    try:
        form = find_format(cells, "")
    except FormatError:  # of day and month, whose order changes no step within a day
        form = DATETIME["dmy"]
    ns = [timestamp.parse_one(c, form) for c in cells]
    steps = sorted(b - a for a, b in pairwise(ns) if NAT not in (a, b))
    if len(steps) < _NEARLY * (len(cells) - 1):
        return False
    usual = steps[len(steps) // 2]
    alike = sum(abs(step - usual) <= usual // 10 for step in steps)
    return 0 < usual <= _LONGEST_STEP and alike >= _NEARLY * len(steps)
