"""`tests_from`: many tests whose conditions stand in their file names, or in a table beside them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from thermodata.archive.members import listed
from thermodata.archive.patterns import in_archives
from thermodata.archive.unpacked import cut_off, held
from thermodata.archive.workbook import check_size
from thermodata.errors import FormatError, SpecError, ThermodataError, nearest
from thermodata.schema.files.campaign import Campaign, Test, TestsFrom
from thermodata.schema.strict.explain import validate
from thermodata.schema.strict.lines import Document, Place
from thermodata.schema.strict.refer import inside
from thermodata.schema.units.value import split_value

_FIELD = re.compile(r"\{([A-Za-z_][A-Za-z0-9_]*)\}")


def expand(campaign: Campaign, document: Document) -> Campaign:
    """The campaign with one test for each file that a `tests_from` finds. Explicit tests of the same id win."""
    specs = campaign.tests_from if isinstance(campaign.tests_from, list) else [campaign.tests_from]
    tests = {t.id.lower(): t for t in campaign.tests}
    for i, spec in enumerate(s for s in specs if s is not None):
        place: Place = ("tests_from", i) if isinstance(campaign.tests_from, list) else ("tests_from",)
        found: dict[str, str] = {}
        for test, file in _from_files(campaign, spec, document, place):
            if test.id.lower() in found:
                raise SpecError(
                    f"two files give the test '{test.id}'",
                    where=document.where(place),
                    got=f"{found[test.id.lower()]} and {file}",
                    hint="set 'id' so that they differ",
                )
            found[test.id.lower()] = file
            tests.setdefault(test.id.lower(), test)
        if not found:
            raise SpecError(
                "no file fits the pattern",
                where=document.where((*place, "files")),
                expected=spec.files,
                got=f"nothing below {document.path.parent.name or '.'}",
                hint="check the folder and the spelling; {name} stands for one part of a file name",
            )
    return campaign.model_copy(update={"tests": list(tests.values()), "tests_from": None})


def _from_files(campaign: Campaign, spec: TestsFrom, document: Document, place: Place) -> list[tuple[Test, str]]:
    inside(spec.files, document, (*place, "files"))
    if spec.source is not None and spec.source not in campaign.sources:
        raise _which_source(campaign, spec, document, place)
    folder = document.path.parent.resolve()
    pattern = pattern_of(spec.files)
    table = _read_table(spec, folder, document, place) if spec.table else {}
    tests = []
    looked_for = _FIELD.sub("*", spec.files)
    packed = {folder / name for name in in_archives(folder, looked_for)}
    for path in sorted({*folder.glob(looked_for), *packed}):
        name = path.relative_to(folder).as_posix()
        match = pattern.fullmatch(name)
        if path in packed and path.is_file():
            _must_be_whole(path, document, place)
        there = path in packed or path.is_file()  # one that an archive refuses is told by who reads it
        if match is None or not there or folder not in path.resolve().parents:
            continue
        fields = match.groupdict()
        conditions = _conditions(spec, fields, table, name, document, place)
        test_id = _FIELD.sub(lambda m, f=fields: f.get(m[1], m[0]), spec.id) if spec.id else path.stem  # type: ignore[misc]
        given: dict[str, Any] = {"role": "none", **spec.set}
        given["conditions"] = {**conditions, **given.get("conditions", {})}
        source = spec.source or _source_of(campaign, name, test_id)
        if source is None:
            raise _which_source(campaign, spec, document, place)
        given |= {"id": test_id, "files": {source: name}}
        try:
            tests.append((validate(Test, Document(document.path, given)), name))
        except SpecError as error:
            raise SpecError(
                error.what,
                where=f"{document.where((*place, 'set'))}, for {name}",
                expected=error.expected,
                got=error.got,
                hint=error.hint,
            ) from None
    return tests


def _must_be_whole(archive: Path, document: Document, place: Place) -> None:
    """SpecError for an archive that can't be read, for it stands for tests that nobody can name."""
    try:
        listed(archive)
    except (OSError, FormatError) as error:
        raise SpecError(
            "an archive of tests can't be read",
            where=document.where((*place, "files")),
            got=f"{archive.name}: {error.got or error.what if isinstance(error, FormatError) else error.strerror}",
            hint="mend it, fetch it anew, or move it out of the folder",
        ) from None


def _source_of(campaign: Campaign, name: str, test: str) -> str | None:
    """The only source; else the one whose own `files` has this file for the test, or the one that says none while no
    other has it. None where that leaves several, or no one."""
    if len(campaign.sources) == 1:
        return next(iter(campaign.sources))
    listed = {k: [s.files] if isinstance(s.files, str) else s.files or [] for k, s in campaign.sources.items()}
    own = [
        k
        for k, patterns in listed.items()
        if any(re.fullmatch(re.escape(test).join(map(_glob_to_regex, p.split("{test}"))), name) for p in patterns)
    ]
    found = own or [k for k, patterns in listed.items() if not patterns]
    return found[0] if len(found) == 1 else None


def _which_source(campaign: Campaign, spec: TestsFrom, document: Document, place: Place) -> SpecError:
    return SpecError(
        "which source are these files?",
        where=document.where((*place, "source")),
        expected="source: one of " + ", ".join(sorted(campaign.sources)),
        got=str(spec.source),
        hint="without 'source' it is the one whose own 'files' names them: files: raw/{test}.csv",
    )


def pattern_of(files: str) -> re.Pattern[str]:
    """A glob with {names} as a regular expression; the same name twice must match the same text."""
    text, seen, last = "", set(), 0
    for field in _FIELD.finditer(files):
        text += _glob_to_regex(files[last : field.start()])
        text += f"(?P={field[1]})" if field[1] in seen else f"(?P<{field[1]}>[^/]+?)"
        seen.add(field[1])
        last = field.end()
    return re.compile(text + _glob_to_regex(files[last:]))


def _glob_to_regex(text: str) -> str:
    return re.escape(text).replace(r"\*\*/", "(?:.*/)?").replace(r"\*", "[^/]*").replace(r"\?", "[^/]")


def _conditions(
    spec: TestsFrom,
    fields: Mapping[str, str],
    table: Mapping[str, Mapping[str, Any]],
    name: str,
    document: Document,
    place: Place,
) -> dict[str, Any]:
    result: dict[str, Any] = {}
    key = spec.table.key if spec.table else None
    for field, text in fields.items():
        if field != key:
            result[field] = _with_unit(text, spec.units.get(field))
    if spec.table is None:
        return result
    row = table.get(_norm(fields.get(spec.table.key, "")))
    if row is None:
        raise SpecError(
            f"the table has no row for '{name}'",
            where=document.where((*place, "table")),
            expected=f"{spec.table.key} = {fields.get(spec.table.key)}",
            got=f"{len(table)} rows in {spec.table.file}",
            hint="add the row, correct the key there, or leave the file out by a narrower pattern in 'files'",
        )
    for condition, column in spec.table.columns.items():
        if _is_empty(row[column]):
            continue
        value = _with_unit(row[column], spec.units.get(condition))
        if condition in result and not _are_same_values(result[condition], value):
            if spec.disagree == "error":
                raise SpecError(
                    f"file name and table disagree on '{condition}'",
                    where=f"{name} and {spec.table.file}",
                    expected=f"{result[condition]} (name)",
                    got=f"{value} (table)",
                    hint="correct one, or set disagree: table or disagree: name",
                )
            if spec.disagree == "name":
                continue
        result[condition] = value
    return result


def _norm(value: Any) -> str:
    """The same key whether the table wrote 7, 7.0, '07' or ' 7 '."""
    text = str(value).strip()
    try:
        number = float(text.replace(",", "."))
    except ValueError:
        return text
    return f"{number:.15g}"  # 15 digits: what a cell of a sheet holds, so that 20260301 is not 20260302


def _is_empty(cell: Any) -> bool:
    """Whether a table says nothing there; pandas has NaN for an empty cell of a sheet."""
    return cell is None or cell != cell or not str(cell).strip()


def _are_same_values(a: Any, b: Any) -> bool:
    try:
        return split_value(a) == split_value(b)
    except ThermodataError:
        return str(a).strip() == str(b).strip()


def _with_unit(value: Any, unit: str | None) -> Any:
    text = str(value).strip()
    try:
        number, written = split_value(text)
    except ThermodataError:
        return text
    if written:
        return text
    return f"{number:.15g} {unit}" if unit else number


def _read_table(spec: TestsFrom, folder: Path, document: Document, place: Place) -> dict[str, Mapping[str, Any]]:
    assert spec.table is not None
    inside(spec.table.file, document, (*place, "table", "file"))
    try:
        with held(folder / spec.table.file) as path:
            if (cut := cut_off(folder / spec.table.file)) is not None:
                raise ValueError(f"{cut}: rows, or the end of one, are missing")
            frame = _frame(path, spec.table.sheet)
    except (OSError, ValueError, ImportError, FormatError) as error:
        raise SpecError(
            "cannot read the table of tests",
            where=document.where((*place, "table", "file")),
            got=f"{spec.table.file}: {error}",
            hint="write it anew as CSV with one header row, in UTF-8",
        ) from None
    columns = [str(c) for c in frame.columns]
    for wanted in (spec.table.key, *spec.table.columns.values()):
        if wanted not in columns:
            close = nearest(wanted, columns)
            raise SpecError(
                f"the table has no column '{wanted}'",
                where=document.where((*place, "table")),
                expected=", ".join(columns),
                got=wanted,
                hint=f"did you mean '{close}'?" if close else None,
            )
    frame.columns = columns
    rows: Sequence[Mapping[Any, Any]] = frame.to_dict("records")
    return _by_key(spec, rows, document, place)


def _by_key(
    spec: TestsFrom, rows: Sequence[Mapping[Any, Any]], document: Document, place: Place
) -> dict[str, Mapping[str, Any]]:
    """The rows by what names the test. SpecError where two rows of one test say different things of it."""
    assert spec.table is not None
    found: dict[str, Mapping[str, Any]] = {}
    for row in rows:
        key = _norm(row[spec.table.key])
        before = found.setdefault(key, row)
        for column in spec.table.columns.values():
            one, other = ("" if _is_empty(r[column]) else str(r[column]).strip() for r in (before, row))
            if key and not _are_same_values(one, other):
                raise SpecError(
                    f"the table has two rows for {spec.table.key} = {key}",
                    where=document.where((*place, "table")),
                    expected="one row a test, or rows that agree",
                    got=f"{column}: '{one}' and '{other}' in {spec.table.file}",
                    hint="take one of them out, or number the tests anew",
                )
    return found


def _frame(path: Path, sheet: int | str | None) -> Any:
    import pandas as pd

    if path.suffix.lower() not in (".xlsx", ".xls", ".ods"):
        return pd.read_csv(path, sep=_delimiter(path), dtype=str, keep_default_na=False, encoding="utf-8-sig")
    if path.suffix.lower() == ".xlsx":
        check_size(path)
    one = sheet - 1 if isinstance(sheet, int) else sheet or 0
    return pd.read_excel(path, sheet_name=one, dtype=object, engine="calamine")


def _delimiter(path: Path) -> str:
    """The delimiter of the table's own header row: the one of ; tab and comma that it holds most of."""
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        header = file.readline(65536)
    return max(";\t,", key=header.count)
