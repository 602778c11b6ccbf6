"""Another program's prediction as an effect: a CSV file with the columns test, t_s, predicted, as `predict --out`
writes them too."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from thermodata.errors import SpecError, nearest
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.plugin import Float1D, Float2D, Gain
from thermodata.reader.text import split_unit
from thermodata.view.dataset import TestData

NAME = "prediction"
_COLUMNS = ("test", "t_s", "predicted")


class Prediction(OfTests):
    """Interpolated onto the grid; NaN outside the times that the file covers. Its gain is 1 unless freed."""

    name = NAME
    family = "prediction"
    meaning = "what another program predicted"
    source = "the file"
    gains = (Gain("gain", "1", (0.0, float("inf")), "any", "factor on the prediction"),)

    def __init__(self, tables: Mapping[str, tuple[Float1D, Float1D]]) -> None:
        self.tables = tables

    def has(self, test: TestData) -> bool:
        return self._key(test) is not None

    def column(self, test: TestData) -> Float2D:
        """shape (n, 1), relative to the first predicted value."""
        key = self._key(test)
        if key is None:
            raise SpecError(f"the prediction file has no test '{test.test}'", expected=", ".join(self.tables))
        t, y = self.tables[key]
        out = np.interp(test.t_s, t, y - y[0], left=0.0)
        # past its end a prediction says nothing; a held value would score as if it did
        return np.where(test.t_s <= t[-1], out, np.nan).reshape(-1, 1)

    def _key(self, test: TestData) -> str | None:
        return next((k for k in (f"{test.campaign}/{test.test}", test.test) if k in self.tables), None)


def read_prediction(path: Path) -> Prediction:
    """Columns test, t_s [s from the test's start], predicted [the response's unit]; units may stand in brackets behind
    the names, and a campaign before the test as campaign/test, or in a column of its own. SpecError with the line
    where a value is no number, or of another response than those before."""
    tables: dict[str, tuple[list[float], list[float]]] = {}
    response: str | None = None
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            rows = csv.DictReader(file)
            names = {split_unit(n)[0].strip().lower(): n for n in rows.fieldnames or []}
            if "t" in names:
                names.setdefault("t_s", names["t"])
            for column in _COLUMNS:
                if column not in names:
                    close = nearest(column, list(names))
                    raise SpecError(
                        f"no column '{column}'",
                        where=str(path),
                        expected=", ".join(_COLUMNS),
                        got=", ".join(names),
                        hint=f"rename '{close}'" if close else None,
                    )
            for row in rows:
                try:
                    t, y = float(row[names["t_s"]]), float(row[names["predicted"]])
                except (TypeError, ValueError):
                    raise SpecError("not a number", where=f"{path}:{rows.line_num}", got=str(row)) from None
                own = row[names["response"]] if "response" in names else None
                response = own if response is None else response
                if own != response:
                    raise SpecError(
                        "a prediction file is of one response",
                        where=f"{path}:{rows.line_num}",
                        expected=str(response),
                        got=str(own),
                        hint="write a file for each: one effect reads one",
                    )
                prefix = f"{row[names['campaign']]}/" if "campaign" in names else ""
                table = tables.setdefault(prefix + row[names["test"]], ([], []))
                table[0].append(t)
                table[1].append(y)
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
    series: dict[str, tuple[Float1D, Float1D]] = {}
    for test, (times, values) in tables.items():
        order = np.argsort(np.asarray(times), kind="stable")
        series[test] = (np.asarray(times)[order], np.asarray(values)[order])
    return Prediction(series)
