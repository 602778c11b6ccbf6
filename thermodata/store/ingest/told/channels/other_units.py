"""Temperatures that stand in kelvins or degrees Fahrenheit in some tests and in degrees in others: one channel, and no
unit in the files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from thermodata.calibration.between_tests.apart_in_fahrenheit import as_ever_in_fahrenheit
from thermodata.calibration.between_tests.levels import Levels
from thermodata.schema.words.sentences import with_count
from thermodata.store.ingest.told.losses import Losses, loss_row

ZERO_K = 273.15
APART_K = 60.0  # two tests of one place differ by less, but for that
NO_HALL_C, _ICE_C = 45.0, 0.0  # no hall is warmer, in which a machine stood before its test, or colder
_ALIKE_F = 12.0  # so far apart are the coldest moments of two tests [degF]
_FEWEST = 2  # one of several alone may have been warm before its test
NOT_HERE_C = (-150.0, 200.0)  # beyond these no part of a machine is all through a test


def fahrenheit_among(coldest: Mapping[str, float]) -> list[str]:
    """The tests or files in which the coldest reading of one channel is that of the others in Fahrenheit. coldest: of
    each, as it stands there."""
    in_degc = [x for x in coldest.values() if _ICE_C <= x < NO_HALL_C]
    if not in_degc:
        return []
    wanted = 1.8 * float(np.median(in_degc)) + 32.0
    return [name for name, x in coldest.items() if x >= NO_HALL_C and abs(x - wanted) <= _ALIKE_F]


def other_units(tests: Sequence[Levels]) -> Losses:
    """A loss for each test in which temperatures stand as far from where they stand in others as kelvins do from
    degrees, or where Fahrenheit's do. tests: in the order of the campaign file."""
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
    losses = [loss_row(_shift_sentence(test, shifts), test=test) for test, shifts in shifted.items()]
    found = _coldest_in_fahrenheit(tests)
    whole = _warmer_throughout(tests, found)
    losses += [loss_row(_in_fahrenheit(test, names), test=test) for test, names in whole]
    told = {test for test, _ in whole}
    some = as_ever_in_fahrenheit(tests, {t: names for t, names in found.items() if t not in told})
    return losses + [loss_row(_alone_in_fahrenheit(test, names), test=test) for test, names in some.items()]


def _coldest_in_fahrenheit(tests: Sequence[Levels]) -> dict[str, list[str]]:
    """Test -> its temperatures whose coldest reading is that of other tests in Fahrenheit."""
    coldest: dict[str, dict[str, float]] = {}
    for levels in tests:
        for name, course in levels.series.items():
            if course.quantity == "temperature" and np.isfinite(course.sound).any() and not levels.warm:
                coldest.setdefault(name, {})[levels.test] = float(np.nanmin(course.sound))
    found: dict[str, list[str]] = {}
    for name, of in coldest.items():
        for test in fahrenheit_among(of):
            found.setdefault(test, []).append(name)
    return found


def _warmer_throughout(tests: Sequence[Levels], found: Mapping[str, Sequence[str]]) -> list[tuple[str, list[str]]]:
    """(test, its temperatures) where all that other tests have, too, stand as Fahrenheit's do to degrees there: a part
    that was warm before leaves the air around it as it is. Of a single one nothing but `start_state: warm` says that.
    found: see `_coldest_in_fahrenheit`."""
    with_values = {t.test: _with_values(t) for t in tests}
    told = []
    for levels in tests:
        elsewhere = {n for t in tests if t is not levels and not t.warm for n in with_values[t.test]}
        own = [name for name in with_values[levels.test] if name in elsewhere]
        alone = len(own) == 1 and sum(c.quantity == "temperature" for c in levels.series.values()) == 1
        if (len(own) >= _FEWEST or alone) and set(own) == set(found.get(levels.test, ())):
            told.append((levels.test, own))
    return told


def _with_values(levels: Levels) -> list[str]:
    return [n for n, c in levels.series.items() if c.quantity == "temperature" and np.isfinite(c.sound).any()]


def _in_fahrenheit(test: str, names: Sequence[str]) -> str:
    shown = with_count(names, 6)
    return (
        f"{shown}: in {test} the coldest readings are to those of the other tests as degF are to degC. If that file is "
        f"in degF, write its unit into the file, or under the test: channels: {{{names[0]}: {{unit: degF}}}}"
        + ("; if it was warm before its test: start_state: warm" if len(names) == 1 else "")
    )


def _alone_in_fahrenheit(test: str, names: Sequence[str]) -> str:
    written = ", ".join(f"{name}: {{unit: degF, instead_of: degC}}" for name in names)
    return (
        f"{with_count(names, 6)}: in {test} the readings lie beyond all that they are beside the other temperatures in "
        "the other tests; taken for degF, not degC, they lie within it. If that column is in degF, "
        f"write under the test: channels: {{{written}}}; if what it measures was warm before the test: "
        "start_state: warm"
    )


def _shift_sentence(test: str, shifts: dict[str, float]) -> str:
    size = float(np.median(list(shifts.values())))
    unit = "K" if size > 0 else "degC"
    shown = with_count(shifts, 6)
    return (
        f"{shown}: in {test} the readings are {size:+.0f} degC from those of the other tests, as kelvins are from "
        f"degrees. If that file is in {unit}, write its unit into the file, or give each channel a twin: the one "
        f"missing_in: [{test}], the other only_in: [{test}] with unit: {unit}"
    )
