"""The rows of another program's prediction: a CSV file with the columns test, t_s, predicted, as `predict --out` writes
them too."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from thermodata.errors import SpecError, UsageError, nearest
from thermodata.modelling.model_file.prediction.cells import Numbers, numbers_of, read_cells
from thermodata.reader.text import split_unit
from thermodata.reader.text.cells.values.number import is_empty
from thermodata.schema.units.conversion import delta_factor

_COLUMNS = ("test", "t_s", "predicted")
_NUMBERS = ("t_s", "predicted")
_KNOWN = (*_COLUMNS, "campaign", "response")
_DIGITS = 6  # of a time [s]: 0.1 min is 6 s, and not a bit more


@dataclass
class Rows:
    """Of one test, as they stand in the file. t_s: from the test's start [s]; y: in the response's unit, NaN where a
    row has no value; line: in the file."""

    t_s: list[float] = field(default_factory=list)
    y: list[float] = field(default_factory=list)
    line: list[int] = field(default_factory=list)


@dataclass(frozen=True)
class _Header:
    """column: its name without unit -> as it stands in the file; at: of those that are read -> where in a row of
    `width` cells; t, y: factors to s and to the response's unit."""

    column: Mapping[str, str]
    at: Mapping[str, int]
    width: int
    t: float
    y: float


def read_rows(path: Path, channels: Mapping[str, str] | None, unit: str | None) -> dict[str, Rows]:
    """test (or campaign/test, where the file names the campaign before it or in a column of its own) -> its rows.

    Cells are parted by commas, semicolons or tabs, and numbers have a decimal point or a comma, one of them in a file.
    Units may stand in brackets behind the names, by default s and the response's (`unit`). channels: campaign -> the
    response's channel there; where not given, a file may be of any one response. SpecError with the line."""
    try:
        cells = read_cells(path)
    except FileNotFoundError:
        raise SpecError(
            "no such prediction file",
            where=str(path.parent),
            expected=f"a CSV file with the columns {', '.join(_COLUMNS)}; its path counts from the model file",
            got=path.name,
            hint="thermodata predict MODEL CAMPAIGN --out FILE.csv writes one",
        ) from None
    except OSError as error:
        raise SpecError(
            "the prediction file cannot be read",
            where=str(path),
            got=str(error),
            hint="a relative path counts from the folder of the model file; the file is a CSV in UTF-8",
        ) from None
    header = _header(cells.header, unit, path, cells.at)
    file = str(path)  # a path is made to text anew each time it is told
    used = [(line, _cells_by_column(row, header, f"{file}:{line}")) for line, row in cells.rows]
    numbers = numbers_of((line, row[key]) for line, row in used for key in _NUMBERS)
    tests: dict[str, Rows] = {}
    only: str | None = None
    for line, row in used:
        where = f"{file}:{line}"
        t = _number(row["t_s"], header.column["t_s"], numbers, where)
        y = _number(row["predicted"], header.column["predicted"], numbers, where, empty=True)
        campaign = row.get("campaign", "")
        if "response" in row:
            only = row["response"] if only is None else only
            _refuse_another(row["response"], only, campaign, channels, where)
        test = tests.setdefault(_key(campaign, row["test"], where), Rows())
        test.t_s.append(round(t * header.t, _DIGITS))
        test.y.append(y * header.y)
        test.line.append(line)
    _refuse_two_names(tests, channels, path)
    return tests


def _cells_by_column(cells: Sequence[str], header: _Header, where: str) -> dict[str, str]:
    """Column -> its cell, of the columns that are read. SpecError for a row that ends before one of them."""
    if len(cells) < header.width and (
        lacking := [header.column[key] for key, i in header.at.items() if i >= len(cells)]
    ):
        raise SpecError(
            "the row has fewer cells than the header",
            where=where,
            expected=f"{header.width}, {', '.join(lacking)} among them",
            got=f"{len(cells)}: {', '.join(cells)}",
            hint="write the row again; where nothing is predicted, leave the cell empty and not out",
        )
    return {key: cells[i].strip() for key, i in header.at.items()}


def _key(campaign: str, test: str, where: str) -> str:
    if not test:
        raise SpecError(
            "the row names no test",
            where=where,
            expected="a test's id",
            got="nothing",
            hint="fill the column 'test' in every row, or leave the row out",
        )
    return test if not campaign or test.startswith(f"{campaign}/") else f"{campaign}/{test}"


def _refuse_two_names(tests: Mapping[str, Rows], channels: Mapping[str, str] | None, path: Path) -> None:
    """SpecError for a test that some rows name alone and some with its campaign: which of them are meant?"""
    for key, rows in tests.items():
        campaign, _, test = key.rpartition("/")
        if campaign and test in tests and (channels is None or campaign in channels):
            alone = tests[test].line[0]
            raise SpecError(
                f"one test by two names, '{test}' and '{key}'",
                where=f"{path}:{max(alone, rows.line[0])}",
                expected="one of them in all its rows",
                got=f"'{test}' at line {alone}, '{key}' at line {rows.line[0]}",
                hint="name the campaign in all rows, or in none",
            )


def _header(titles: Sequence[str], unit: str | None, path: Path, line: int) -> _Header:
    where = f"{path}:{line}"
    column: dict[str, str] = {}
    units: dict[str, str | None] = {}
    at: dict[str, int] = {}
    for i, title in enumerate(titles):
        name, own = split_unit(title)
        key = name.strip().lower()
        if key in column and key in (*_KNOWN, "t"):
            raise SpecError(
                f"two columns '{key}'",
                where=where,
                expected="one",
                got=f"{column[key]}, {title}",
                hint="leave one of the two out of the file",
            )
        column[key], units[key], at[key] = title, own, i
    if "t_s" not in column and "t" in column:
        column["t_s"], units["t_s"], at["t_s"] = column["t"], units["t"], at["t"]
    elif units.get("t_s") is not None and _factor(units["t_s"], "s", "t_s", where) != 1:
        raise SpecError(
            "the time's name says s, and its unit another",
            where=where,
            expected=f"t [{units['t_s']}], or t_s",
            got=column["t_s"],
            hint="correct the column's header",
        )
    for key in _COLUMNS:
        if key not in column:
            close = nearest(key, list(column))
            raise SpecError(
                f"no column '{key}'",
                where=str(path),
                expected=", ".join(_COLUMNS),
                got=", ".join(column),
                hint=f"rename '{close}'" if close else None,
            )
    of_y = 1.0 if unit is None else _factor(units["predicted"], unit, "predicted", where)
    read = {key: at[key] for key in _KNOWN if key in at}
    return _Header(column, read, len(titles), _factor(units["t_s"], "s", "t", where), of_y)


def _factor(given: str | None, wanted: str, name: str, where: str) -> float:
    """Of a difference: what is predicted counts from its first value."""
    if given is None:
        return 1.0
    try:
        return delta_factor(given, wanted)
    except UsageError:
        raise SpecError(
            f"the column '{name}' has a unit of another kind",
            where=where,
            expected=f"{wanted}, or what converts to it",
            got=given,
            hint="correct the unit in the column's header, or convert the values before",
        ) from None


def _number(text: str, column: str, numbers: Numbers, where: str, *, empty: bool = False) -> float:
    """SpecError for what is no finite number. empty: nothing and NaN are taken, as NaN."""
    if is_empty(text):
        if empty:
            return math.nan
        value = None
    else:
        value = numbers.value(text)
    if value is None or not math.isfinite(value):
        raise SpecError(
            f"'{column}': not a number",
            where=where,
            expected=numbers.expected(),
            got=text or "nothing",
            hint="leave the cell empty where nothing is predicted",
        )
    return value


def _refuse_another(own: str, first: str, campaign: str, channels: Mapping[str, str] | None, where: str) -> None:
    if channels is None:
        wanted = [first]
    else:
        wanted = [channels[campaign]] if campaign in channels else list(dict.fromkeys(channels.values()))
    if own not in wanted:
        raise SpecError(
            "a prediction file is of one response, and of the model's",
            where=where,
            expected=" or ".join(wanted),
            got=own,
            hint="write a file for each: one effect reads one; of a model with several responses, say which it acts "
            "on: acts_on: [{channel: NAME}]",
        )
