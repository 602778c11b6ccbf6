"""The rows of another program's prediction: a CSV file with the columns test, t_s, predicted, as `predict --out` writes
them too."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from thermodata.errors import SpecError, UsageError, nearest
from thermodata.reader.text import split_unit
from thermodata.schema.quantity import delta_factor

_COLUMNS = ("test", "t_s", "predicted")
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
    """column: its name without unit -> as it stands in the file; t, y: factors to s and to the response's unit."""

    column: Mapping[str, str]
    t: float
    y: float


def read_rows(path: Path, channels: Mapping[str, str] | None, unit: str | None) -> dict[str, Rows]:
    """test (or campaign/test, where the file names the campaign before it or in a column of its own) -> its rows.

    Units may stand in brackets behind the names, by default s and the response's (`unit`). channels: campaign -> the
    response's channel there; where not given, a file may be of any one response. SpecError with the line."""
    tests: dict[str, Rows] = {}
    only: str | None = None
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            rows = csv.DictReader(file)
            header = _header(rows.fieldnames or [], unit, path)
            name = header.column
            for row in rows:
                where = f"{path}:{rows.line_num}"
                t, y = _number(row, name["t_s"], where), _number(row, name["predicted"], where, empty=True)
                campaign = row[name["campaign"]] if "campaign" in name else ""
                if "response" in name:
                    only = row[name["response"]] if only is None else only
                    _refuse_another(row[name["response"]], only, campaign, channels, where)
                test = tests.setdefault((f"{campaign}/" if campaign else "") + row[name["test"]], Rows())
                test.t_s.append(round(t * header.t, _DIGITS))
                test.y.append(y * header.y)
                test.line.append(rows.line_num)
    except FileNotFoundError:
        raise SpecError(
            "no such prediction file",
            where=str(path.parent),
            expected=f"a CSV file with the columns {', '.join(_COLUMNS)}; its path counts from the model file",
            got=path.name,
            hint="thermodata predict MODEL CAMPAIGN --out FILE.csv writes one",
        ) from None
    except (OSError, UnicodeDecodeError) as error:
        raise SpecError("the prediction file cannot be read", where=str(path), got=str(error)) from None
    return tests


def _header(titles: Sequence[str], unit: str | None, path: Path) -> _Header:
    column: dict[str, str] = {}
    units: dict[str, str | None] = {}
    for title in titles:
        name, own = split_unit(title)
        key = name.strip().lower()
        if key in column and key in (*_COLUMNS, "t"):
            raise SpecError(f"two columns '{key}'", where=f"{path}:1", expected="one", got=f"{column[key]}, {title}")
        column[key], units[key] = title, own
    if "t_s" not in column and "t" in column:
        column["t_s"], units["t_s"] = column["t"], units["t"]
    elif units.get("t_s") is not None and _factor(units["t_s"], "s", "t_s", path) != 1:
        raise SpecError(
            "the time's name says s, and its unit another",
            where=f"{path}:1",
            expected=f"t [{units['t_s']}], or t_s",
            got=column["t_s"],
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
    of_y = 1.0 if unit is None else _factor(units["predicted"], unit, "predicted", path)
    return _Header(column, _factor(units["t_s"], "s", "t", path), of_y)


def _factor(given: str | None, wanted: str, name: str, path: Path) -> float:
    """Of a difference: what is predicted counts from its first value."""
    if given is None:
        return 1.0
    try:
        return delta_factor(given, wanted)
    except UsageError:
        raise SpecError(
            f"the column '{name}' has a unit of another kind",
            where=f"{path}:1",
            expected=f"{wanted}, or what converts to it",
            got=given,
        ) from None


def _number(row: Mapping[str, str | None], column: str, where: str, *, empty: bool = False) -> float:
    """SpecError for what is no finite number. empty: nothing and NaN are taken, as NaN."""
    text = (row[column] or "").strip()
    if empty and text.lower() in ("", "nan"):
        return math.nan
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise SpecError(f"'{column}': not a number", where=where, expected="a finite number", got=text or "nothing")
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
