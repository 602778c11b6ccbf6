"""Another program's prediction as an effect, interpolated from its file onto the grid of a test."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from thermodata.errors import SpecError, nearest
from thermodata.modelling.model_file.prediction.file import Rows, read_rows
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.plugin import Effect, Float1D, Float2D, Gain
from thermodata.schema.words.sentences import counted
from thermodata.view.grid.dataset import Dataset, TestData

NAME = "prediction"
_SHOWN = 4


class Series(NamedTuple):
    """Of one test. t_s: increasing [s], shape (n,); y: shape (n,), NaN where the file has a time and no value."""

    t_s: Float1D
    y: Float1D

    def at(self, t_s: Float1D) -> Float1D:
        """On straight lines between rows that have a value, relative to the first of these; NaN elsewhere."""
        known = np.isfinite(self.y)
        t, y = self.t_s[known], self.y[known]
        out = np.interp(t_s, t, y - y[0], left=np.nan, right=np.nan)
        # a value held beyond the rows, or a line across an empty one, would score as if it had been predicted
        last = len(self.t_s) - 1
        before = np.clip(np.searchsorted(self.t_s, t_s, side="right") - 1, 0, last)
        after = np.clip(np.searchsorted(self.t_s, t_s), 0, last)
        return np.where(known[before] & known[after], out, np.nan)


class Prediction(OfTests):
    """NaN outside the times that the file covers, and beside its rows without a value. Its gain is 1 unless freed.
    file: its name; notes: what is to be known of it, whatever is fitted."""

    name = NAME
    family = "prediction"
    meaning = "what another program predicted"
    source = "the file"
    gains = (Gain("gain", "1", (0.0, float("inf")), "any", "factor on the prediction"),)

    def __init__(self, tables: Mapping[str, Series], file: str, notes: tuple[str, ...] = ()) -> None:
        self.tables, self.file, self.notes = tables, file, notes

    def has(self, test: TestData) -> bool:
        return self._key(test) is not None

    def lacks(self, test: TestData) -> str:
        return f"{self.file} is of {_names_shown(list(self.tables))}"

    def column(self, test: TestData) -> Float2D:
        """shape (n, 1), relative to the first predicted value."""
        key = self._key(test)
        if key is None:
            raise SpecError(
                f"the prediction file has no test '{test.test}'",
                where=self.file,
                expected=", ".join(self.tables),
                got=test.test,
                hint="add its rows, or keep the test out of this model's fit and scores",
            )
        return self.tables[key].at(test.t_s).reshape(-1, 1)

    def _key(self, test: TestData) -> str | None:
        return next((k for k in _names(test) if k in self.tables), None)


def _names(test: TestData) -> tuple[str, str]:
    """What a file may call a test."""
    return f"{test.campaign}/{test.test}", test.test


def said(effect: Effect, data: Dataset) -> tuple[str, ...]:
    """What whoever reads a fit to `data` should know of the file of a prediction; of any other effect nothing."""
    return (*effect.notes, *_of_no_test(effect, data)) if isinstance(effect, Prediction) else ()


def _names_shown(tests: Sequence[str]) -> str:
    return ", ".join(f"'{test}'" for test in tests[:_SHOWN]) + (", ..." if len(tests) > _SHOWN else "")


def _of_no_test(effect: Prediction, data: Dataset) -> list[str]:
    known = [name for test in data.tests for name in _names(test)]
    strange = [test for test in effect.tables if test not in known]
    if not strange:
        return []
    shown = _names_shown(strange)
    near = next(filter(None, (nearest(test, known) for test in strange)), None)
    asked = f"; did you mean '{near}'?" if near else ""
    are = f"{shown} is no test" if len(strange) == 1 else f"{shown} are no tests"
    return [f"{effect.file}: {are} with data of the model's campaigns, and nothing of it is used{asked}"]


def read_prediction(path: Path, channels: Mapping[str, str] | None = None, unit: str | None = None) -> Prediction:
    """The file as an effect on one response. channels: campaign -> the response's channel there; unit: the response's.

    SpecError with the line where a value is no number, a test has two values at one time, a row is of another response
    or the header in a unit of another kind; and where no row has a value."""
    rows = read_rows(path, channels, unit)
    empty = sorted(n for own in rows.values() for y, n in zip(own.y, own.line, strict=True) if not np.isfinite(y))
    count = sum(len(own.y) for own in rows.values())
    if len(empty) == count:
        raise SpecError(
            "no row of the prediction file has a value",
            where=f"{path}:{empty[0] if empty else 1}",
            expected="numbers in the column 'predicted'",
            got=f"none in {counted(count, 'row')}",
            hint="write the predictions as plain numbers; what is not predicted may stay empty",
        )
    tables = {test: series for test, own in rows.items() if np.isfinite((series := _series(own, test, path)).y).any()}
    return Prediction(tables, path.name, _notes(path, empty, count, [test for test in rows if test not in tables]))


def _series(rows: Rows, test: str, path: Path) -> Series:
    order = np.argsort(np.asarray(rows.t_s), kind="stable")
    t, y, lines = np.asarray(rows.t_s)[order], np.asarray(rows.y)[order], np.asarray(rows.line)[order]
    again = np.diff(t, prepend=np.nan) == 0
    differs = np.flatnonzero(again & ~np.isclose(y, np.roll(y, 1), rtol=1e-12, atol=0.0, equal_nan=True))
    if len(differs):
        i = int(differs[0])
        raise SpecError(
            f"two predictions of test '{test}' at one time",
            where=f"{path}:{lines[i]}",
            expected=f"{y[i - 1]:g} as at line {lines[i - 1]}, or another time than {t[i]:g} s",
            got=f"{y[i]:g}",
            hint="keep one of the two rows",
        )
    return Series(t[~again], y[~again])


def _notes(path: Path, empty: list[int], count: int, lost: list[str]) -> tuple[str, ...]:
    if not empty:
        return ()
    tests = f"; nothing is left of {', '.join(lost)}" if lost else ""
    return (
        f"{path.name}: {len(empty)} of {counted(count, 'row', 'has', 'have')} no predicted value (the first at line "
        f"{empty[0]}): between them and the rows beside them the model says nothing, and nothing counts{tests}",
    )
