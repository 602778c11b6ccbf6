"""Temperatures that stand in kelvins in some tests and in degrees in others: one channel, and no unit in the files."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.calibration.between_tests.levels import Levels
from thermodata.schema.words.sentences import with_count
from thermodata.store.ingest.told.losses import Losses, loss_row

ZERO_K = 273.15
APART_K = 60.0  # two tests of one place differ by less, but for that
NOT_HERE_C = (-150.0, 200.0)  # beyond these no part of a machine is all through a test


def other_units(tests: Sequence[Levels]) -> Losses:
    """A loss for each test in which temperatures stand as far from where they stand in others as kelvins do from
    degrees. tests: in the order of the campaign file."""
    medians: dict[str, dict[str, float]] = {}
    for levels in tests:
        for name, course in levels.series.items():
            known = course.values[np.isfinite(course.values)]
            if course.quantity == "temperature" and len(known):
                medians.setdefault(name, {})[levels.test] = float(np.median(known))
    shifted: dict[str, dict[str, float]] = {}
    for name, of in medians.items():
        usual = [m for m in of.values() if NOT_HERE_C[0] < m < NOT_HERE_C[1]]
        for test, median in of.items():
            shift = median - float(np.median(usual)) if usual and median not in usual else 0.0
            if abs(abs(shift) - ZERO_K) < APART_K:
                shifted.setdefault(test, {})[name] = shift
    return [loss_row(_said(test, shifts), test=test) for test, shifts in shifted.items()]


def _said(test: str, shifts: dict[str, float]) -> str:
    size = float(np.median(list(shifts.values())))
    unit = "K" if size > 0 else "degC"
    shown = with_count(shifts, 6)
    return (
        f"{shown}: in {test} the readings are {size:+.0f} degC from those of the other tests, as kelvins are from "
        f"degrees. If that file is in {unit}, write its unit into the file, or give each channel a twin: the one "
        f"missing_in: [{test}], the other only_in: [{test}] with unit: {unit}"
    )
