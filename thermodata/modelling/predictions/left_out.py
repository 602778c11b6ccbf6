"""FIT on what a fit has not seen: a test left out, or a part in time where there is only one test."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.modelling.predictions.score import fit_percent
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.plugin import Bool1D, Float1D
from thermodata.view.grid.dataset import TestData

MOST = 6  # folds; more tests than that are left out in groups
PARTS = 4  # of one test

Mask = Callable[[TestData], Bool1D]
Refit = Callable[[Sequence[TestData]], FittedResponse]


@dataclass(frozen=True)
class Fold:
    """train: what is fitted. left_out: tests to score, each from its own mean (of a part: from the mean of the rest,
    which is the offset that the fit gave the test)."""

    train: tuple[TestData, ...]
    left_out: tuple[TestData, ...]
    rest: TestData | None = None


def folds(tests: Sequence[TestData], channel_of: Callable[[TestData], str], mask: Mask) -> list[Fold]:
    """Every test, or part of the one test, is left out once; none where there is nothing to leave out."""
    usable = [t for t in tests if mask(t).any()]
    if len(usable) > 1:
        count = min(MOST, len(usable))
        groups = [usable[k::count] for k in range(count)]
        return [Fold(tuple(t for t in usable if t not in group), tuple(group)) for group in map(tuple, groups)]
    found = []
    for test in usable:
        rows = np.flatnonzero(mask(test))
        # what a method counts the response from is no part of what it has to foretell
        first = test.t_s < test.t_s[rows[0]] + test.zero_s
        for part in np.array_split(rows, PARTS) if len(rows) >= 5 * PARTS else []:
            inside = np.zeros(len(test.t_s), bool)
            inside[part[0] : part[-1] + 1] = True
            inside &= ~first
            if not inside.any():
                continue
            rest = _valid_only(test, channel_of(test), ~inside)
            found.append(Fold((rest,), (_valid_only(test, channel_of(test), inside),), rest))
    return found


def left_out_fit(found: Sequence[Fold], refit: Refit) -> tuple[float, float]:
    """FIT [%] over all that was left out, together, and that of the worst fold. Free run; -inf where nothing counts."""
    measured: list[Float1D] = []
    residual: list[Float1D] = []
    for fold in found:
        response = refit(fold.train)
        offset = None if fold.rest is None else response.offset(fold.rest, "free")
        ys, rs = [], []
        for test in fold.left_out:
            counted = response.mask(test)
            y = response.measured(test)[counted]
            r = y - response.predict(test)[counted]
            ys.append(y)
            rs.append(r - (r.mean() if offset is None and len(r) else offset or 0.0))
        measured.append(np.concatenate(ys) if fold.rest is not None else np.concatenate([y - y.mean() for y in ys]))
        residual.append(np.concatenate(rs))
    single = bool(found) and found[0].rest is not None
    every = [_percent(y, r) for y, r in zip(measured, residual, strict=True)]
    if not measured:
        return -np.inf, -np.inf
    whole = np.concatenate(measured)
    total = _percent(whole - whole.mean() if single else whole, np.concatenate(residual))
    return total, min(every)


def _percent(measured: Float1D, residual: Float1D) -> float:
    fit = fit_percent(measured, residual) if len(measured) else None
    return -np.inf if fit is None else fit


def _valid_only(test: TestData, channel: str, where: Bool1D) -> TestData:
    valid = test.valid.get(channel, np.ones(len(test.t_s), bool))
    return replace(test, valid={**test.valid, channel: valid & where})
