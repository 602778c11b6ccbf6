"""Whether a stated probability is what it says: shares that came true against what was stated, Brier score, error.

Brier score: mean square of (stated - came true) (Brier 1950); expected calibration error: mean distance between what
was stated and what came true, over bins, by their size.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from thermodata.virtual.blind.tally import wilson

BINS = 10
SORTS = ("first", "claim")


@dataclass(frozen=True, slots=True)
class Bin:
    """Statements of one tenth. stated: mean of what was stated. true: share that came true, low to high: Wilson."""

    stated: float
    true: float
    low: float
    high: float
    of: int


@dataclass(frozen=True, slots=True)
class Reliability:
    """of: first (the first-ranked candidate of each trial) or claim. base_brier: of stating the mean share always."""

    of: str
    statements: int
    brier: float
    base_brier: float
    calibration_error: float
    bins: tuple[Bin, ...]

    def to_json(self) -> dict[str, Any]:
        return asdict(self)


def reliability(trials: Sequence[Mapping[str, Any]]) -> list[Reliability]:
    """One a sort of statement; a sort of which no trial states a probability is left out."""
    found = []
    for sort in SORTS:
        said = [s for t in trials for s in t["stated"] if s["of"] == sort and s["probability"] is not None]
        if said:
            found.append(
                _reliability_of(sort, np.array([s["probability"] for s in said]), np.array([s["right"] for s in said]))
            )
    return found


def _reliability_of(sort: str, stated: np.ndarray, right: np.ndarray) -> Reliability:
    true = right.astype(float)
    number = np.minimum((stated * BINS).astype(int), BINS - 1)
    bins = []
    for k in np.unique(number):
        here = number == k
        hits, of = int(true[here].sum()), int(here.sum())
        low, high = wilson(hits, of) or (0.0, 1.0)
        bins.append(Bin(float(stated[here].mean()), hits / of, low, high, of))
    return Reliability(
        sort,
        len(stated),
        float(np.mean((stated - true) ** 2)),
        float(true.mean() * (1 - true.mean())),
        float(sum(b.of * abs(b.stated - b.true) for b in bins) / len(stated)),
        tuple(bins),
    )
