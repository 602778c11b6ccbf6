"""Logs that are drafted as a test each, though neither a date nor a name tells them apart: loggers that ran at once, or
parts that each count from 0, look just so."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping, Sequence

from thermodata.draft.files.blocks import is_called_test, is_test_number
from thermodata.draft.files.day_in_name import follow_by_names
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.words.filenames import without_part
from thermodata.draft.words.said_by_names import said_by
from thermodata.reader.files.rotated import age, unrotated
from thermodata.schema.words.sentences import with_dots

_NAMED = 4
_BOOKS = (".xlsx", ".xlsm")
# what programs call a sheet that nobody named, and what anything is called
_NO_NAME = re.compile(
    r"(?i)(sheet|tabelle|feuille?|foglio|hoja|planilha|folha|list|arkusz|blad|ark|munka(lap)?|лист|工作表|シート|"
    r"data|daten|dati|datos|dane|log(ger)?|table|kanal|channel|group|gruppe|untitled|unbenannt|export|series)[ _.-]*"
    r"(\(?\d*\)?)"
)


def one_or_many(group: Group, groups: Sequence[Group], listed: Collection[str]) -> tuple[str, ...]:
    """What to ask of a source whose tests may be one. listed: the tests that a table names."""
    tests = {t: f for t, f in group.tests.items() if t not in listed and not _dated(t, groups)}
    return (*_of_sheets(tests, group), *_of_files(tests, group), *_of_joined(tests), *_side_by_side(group))


def _side_by_side(group: Group) -> list[str]:
    """Tables of the same columns that stand beside each other, each under a title: the file is read as one test."""
    for file in group.files:
        own: dict[str, set[str]] = {}
        for signal in file.signals:
            title, _, rest = signal.stream.rpartition("/")
            if title and rest and signal.name.startswith(f"{title}/"):
                own.setdefault(title, set()).add(signal.name.removeprefix(f"{title}/"))
        alike = [t for t, names in own.items() if sum(len(names & o) * 2 > len(names) for o in own.values()) > 1]
        if file.sheet is None and len(alike) > 1:
            kind, each = ("a sheet", ', and table: {sheet: "{test}"}') if _is_book(file) else ("a file", "")
            return [
                f"{_shown(alike)} stand side by side in {file.path} with the same columns: a test each? They are read "
                f"as one test: put each into {kind} of its own{each}, then thermodata init --force"
            ]
    return []


def _is_book(file: RawFile) -> bool:
    return file.path.suffix.lower() in _BOOKS


def _of_sheets(tests: dict[str, tuple[RawFile, ...]], group: Group) -> list[str]:
    """Sheets and groups of a file at one rate: other rates, and those in every file, are known for loggers."""
    files = [f for own in tests.values() for f in own if f.sheet]
    if len(files) < 2 or len(files) < len(group.files) or told_apart(files):
        return []
    names = [f.sheet or "" for f in files]
    if not (
        len({re.sub(r"\d+", "#", n) for n in names}) == 1 or all(map(_NO_NAME.fullmatch, names)) or _end_at_once(files)
    ):
        return []
    return [
        f"{_shown(names)} are a test each here, but neither dates nor names say so: loggers of one test? then take "
        "'sheet' out of table, write one test, and signal: 'sheet/name' for each channel"
    ]


def _of_files(tests: dict[str, tuple[RawFile, ...]], group: Group) -> list[str]:
    """Files whose names only count them, and that each begin at 0."""
    alike = _put_aside(tests)
    put_aside, pieces = set(alike), {test for own in alike.values() for test in own}
    for test, own in tests.items():
        if (
            test not in pieces
            and len(own) == 1
            and own[0].part is None
            and (base := without_part(test)) != test
            and not is_called_test(re.split(r"[\s_.-]", base)[-1])
        ):
            alike.setdefault(base, {})[test] = own[0]
    return [
        f"{_shown(own)} each count from 0, and nothing dates them: a test each, or parts of one? then write one test, "
        f"{base}, with files: {{{group.source}: {_files(own, base in put_aside)}}}; they are put end to end in this "
        "order"
        for base, own in alike.items()
        if len(own) > 1 and all(map(_begins_at_0, own.values())) and not _said_apart(list(own), lambda _: False)
    ]


def _files(own: Mapping[str, RawFile], put_aside: bool) -> str:
    """The files of a test as a campaign file lists them; many pieces of one log by a pattern, which takes the oldest
    first too."""
    if put_aside and len(own) > _NAMED:
        return f'"{unrotated(next(iter(own.values())).path)}*"'
    shown = ", ".join(str(f.path) for f in list(own.values())[:_NAMED])
    return f"[{shown}{', ...' if len(own) > _NAMED else ''}]"


def _put_aside(tests: dict[str, tuple[RawFile, ...]]) -> dict[str, dict[str, RawFile]]:
    """Log -> the tests that are pieces of it by their names, the oldest first, and the log itself last."""
    single = {own[0].path: (test, own[0]) for test, own in tests.items() if len(own) == 1 and own[0].part is None}
    logs = {unrotated(path) for path in single} & {unrotated(path) for path in single if unrotated(path) != path}
    return {
        log.stem: dict(single[path] for path in sorted((p for p in single if unrotated(p) == log), key=age))
        for log in sorted(logs)
    }


def _of_joined(tests: dict[str, tuple[RawFile, ...]]) -> list[str]:
    """Files that names of another source make parts of one test, and that each begin at 0."""
    return [
        f"{_shown([f.path.name for f in own])} of {test} each count from 0, and nothing dates them: they are put end "
        "to end in this order; was there a pause between them? then each is a test"
        for test, own in tests.items()
        if len(own) > 1 and not any(f.part for f in own) and all(map(_begins_at_0, own)) and not follow_by_names(own)
    ][:1]


def told_apart(files: Sequence[RawFile]) -> bool:
    """Whether the name of each sheet says what its test was: a speed, a date, or its number; and none as another."""
    return _said_apart([f.sheet or "" for f in files], is_test_number)


def _said_apart(names: Sequence[str], is_number: Callable[[str], bool]) -> bool:
    said = []
    for name in names:
        of = said_by([name])
        if not (of.conditions or of.speeds or of.start or is_number(name)):
            return False
        said.append((*sorted(of.conditions.items()), of.speeds, of.start, name if is_number(name) else ""))
    return len(set(said)) == len(said)


def _dated(test: str, groups: Sequence[Group]) -> bool:
    """Whether any log of a test says when it began, or its head may."""
    return any(f.may_be_dated for g in groups for f in g.tests.get(test, ()))


def _begins_at_0(file: RawFile) -> bool:
    first, last = file.sample.first_ns, file.sample.last_ns
    return first is not None and last is not None and 0 <= first <= (last - first) // 10


def _end_at_once(files: Sequence[RawFile]) -> bool:
    ends = {(f.sample.first_ns, f.sample.last_ns, f.sample.rows) for f in files}
    return len(ends) == 1 and all(f.sample.whole and f.sample.rows for f in files)


def _shown(names: Collection[str]) -> str:
    return with_dots([f"'{n}'" for n in names], _NAMED)
