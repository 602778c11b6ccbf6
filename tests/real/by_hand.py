"""The spindle recording by hand, beside the program: plain lags, trained on the first 70 %, in numpy and scipy.

`uv run --no-sync python tests/real/by_hand.py` prints the tables that docs/real_spindle.md quotes. It imports nothing
of thermodata. The locked part is looked at freely here: it explains figures that are known, it chooses nothing.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from python_calamine import CalamineWorkbook
from scipy.optimize import minimize
from scipy.signal import coherence, csd, lfilter, welch

FILE = Path(__file__).parents[2] / ".." / "shared" / "data" / "fl_thermal" / "data.xlsx"
STEP_S = 60.0  # [s] four rows of 15 s
HALF_H, CUT_H = 16.1, 32.4  # [h] where the campaign's first two tests end
STARTS_MIN = (15.0, 90.0, 330.0)  # [min] each lag is searched from each of them
BANKS_MIN = ((90,), (60, 180), (30, 60, 90), (10, 60, 120), (5, 20, 60, 120, 360))
GRID_MIN = (10, 20, 30, 45, 60, 90, 120, 180, 240, 360)
PROBES = (3, 1, 5)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Rows:
    """The recording in means of a minute. t_h, speed: shape (n,); ch: 1 to 5 [um] and t: 1 to 16 [degC], by number."""

    t_h: Array
    speed: Array
    ch: dict[int, Array]
    t: dict[int, Array]


def read(file: Path = FILE) -> Rows:
    """The sheet's numbers; the last rows that fill no minute are left out."""
    sheet = CalamineWorkbook.from_path(file).get_sheet_by_index(0).to_python()[1:]
    rows = np.array(sheet, dtype=np.float64)
    minutes = rows[: len(rows) // 4 * 4].reshape(-1, 4, rows.shape[1]).mean(axis=1)
    return Rows(
        minutes[:, 0] / 3600,
        minutes[:, 1],
        {k: minutes[:, 1 + k] for k in range(1, 6)},
        {k: minutes[:, 6 + k] for k in range(1, 17)},
    )


def lag(u: Array, tau_min: float) -> Array:
    """u, counted from its first value, through one lag at rest before; u runs straight between the minutes."""
    keeps = np.exp(-STEP_S / 60 / tau_min)
    mean = (1 - keeps) * tau_min * 60 / STEP_S  # of the decay over a minute
    return np.asarray(lfilter([1 - mean, mean - keeps], [1, -keeps], u - u[0]))


@dataclass(frozen=True)
class Fit:
    """taus_min: of each driver. left: the residual [um], shape (n,): of a part about its own fitted level, beyond all
    of them about the mean of these."""

    taus_min: tuple[tuple[float, ...], ...]
    gains: Array
    left: Array


def solve(y: Array, drivers: Sequence[Array], taus: Sequence[Sequence[float]], parts: Sequence[slice]) -> Fit:
    """Gains and a level a part by least squares over the parts, for lags that are given."""
    columns = np.column_stack([lag(u, tau) for u, some in zip(drivers, taus, strict=True) for tau in some])
    levels = np.zeros((len(y), len(parts)))
    for k, part in enumerate(parts):
        levels[part, k] = 1
    fitted = np.r_[tuple(np.r_[part] for part in parts)]
    found = np.linalg.lstsq(np.column_stack([columns, levels])[fitted], y[fitted], rcond=None)[0]
    gains, level = found[: columns.shape[1]], found[columns.shape[1] :]
    left: Array = np.asarray(y - columns @ gains - level.mean(), dtype=np.float64)
    for part, own in zip(parts, level, strict=True):
        left[part] += level.mean() - own
    return Fit(tuple(tuple(some) for some in taus), np.asarray(gains), left)


def search(y: Array, drivers: Sequence[Array], parts: Sequence[slice], lags: int = 1) -> Fit:
    """Time constants, too: least squares over the parts, from several starts."""

    def as_taus(logs: Array) -> list[list[float]]:
        return [list(np.exp(some)) for some in np.reshape(logs, (len(drivers), lags))]

    def cost(logs: Array) -> float:
        if np.any(logs < 0) or np.any(logs > np.log(1440)):  # 1 min to 24 h
            return 1e9
        left = solve(y, drivers, as_taus(logs), parts).left
        return float(np.mean(np.concatenate([left[p] for p in parts]) ** 2))

    starts = itertools.product(itertools.combinations(STARTS_MIN, lags), repeat=len(drivers))
    tried = [
        minimize(
            cost, np.log(np.ravel(s)), method="Nelder-Mead", options={"xatol": 1e-3, "fatol": 1e-5, "maxiter": 600}
        )
        for s in starts
    ]
    best = min(tried, key=lambda one: float(one.fun))
    return solve(y, drivers, as_taus(best.x), parts)


def rms(x: Array) -> float:
    return float(np.sqrt(np.mean(x**2)))


def scores(left: Array, first: int) -> dict[str, float]:
    """RMS [um] of what is left from a row on, by how the level is set."""
    locked = left[first:]
    return {
        "fitted level": rms(locked),
        "own mean": rms(locked - locked.mean()),
        "first 10 min": rms(locked - locked[:10].mean()),
        "first minute": rms(locked - locked[0]),
    }


def row(*cells: object) -> None:
    print("| " + " | ".join(f"{c:.2f}" if isinstance(c, float) else str(c) for c in cells) + " |", flush=True)


def head(*cells: str) -> None:
    print()
    row(*cells)
    row(*["---"] * len(cells))


def taus(fit: Fit) -> str:
    return "; ".join(", ".join(f"{tau:.0f}" for tau in some) for some in fit.taus_min)


def levels(rows: Rows) -> None:
    """One lag a driver: what is left of the locked part, by how its level is set, and how many levels the fit had."""
    half, cut = (int(np.searchsorted(rows.t_h, h)) for h in (HALF_H, CUT_H))
    ways = {"one level": [slice(0, cut)], "a level for each half": [slice(0, half), slice(half, cut)]}
    head(
        "probe",
        "drivers",
        "fit",
        "time constants [min]",
        "trained",
        "fitted level",
        "own mean",
        "first 10 min",
        "first minute",
    )
    for ch, (way, parts) in itertools.product(PROBES, ways.items()):
        for name, drivers in (("speed", [rows.speed]), ("speed, t4", [rows.speed, rows.t[4]])):
            fit = search(rows.ch[ch], drivers, parts)
            row(f"ch{ch}", name, way, taus(fit), rms(fit.left[:cut]), *scores(fit.left, cut).values())


def banks(rows: Rows) -> None:
    """Several fixed lags a driver, one level: errors about it, and how they scatter over all banks of two or three."""
    cut = int(np.searchsorted(rows.t_h, CUT_H))
    sets = {"speed": [rows.speed], "with t4": [rows.speed, rows.t[4]], "with t5": [rows.speed, rows.t[5]]}

    def found(bank: Sequence[float]) -> list[tuple[float, float]]:
        """RMS trained and locked [um] of each probe and set."""
        fits = [solve(rows.ch[ch], d, [bank] * len(d), [slice(0, cut)]).left for ch in PROBES for d in sets.values()]
        return [(rms(left[:cut]), rms(left[cut:])) for left in fits]

    head("lags of each driver [min]", *(f"ch{ch} {name}" for ch in PROBES for name in sets))
    for bank in BANKS_MIN:
        row(", ".join(map(str, bank)), *(locked for _, locked in found(bank)))
    every = [found(bank) for n in (2, 3) for bank in itertools.combinations(GRID_MIN, n)]
    by = [sorted(column) for column in zip(*every, strict=True)]
    row(f"best trained of {len(every)} banks", *(column[0][1] for column in by))
    for name, share in (("least", 0), ("median", 50), ("most", 100)):
        row(f"{name} of them", *(float(np.percentile([b for _, b in column], share)) for column in by))


def other_cuts(rows: Rows) -> None:
    """ch3 with t4, one lag each: the same fit, its locked part begun at other hours."""
    cut = int(np.searchsorted(rows.t_h, CUT_H))
    fit = search(rows.ch[3], [rows.speed, rows.t[4]], [slice(0, cut)])
    head("level set at [h]", "what ran", "fitted level", "own mean", "first 10 min")
    for h in (31.0, 32.0, CUT_H, 33.0, 34.0, 36.0, 40.0):
        at = int(np.searchsorted(rows.t_h, h))
        found = scores(fit.left, at)
        row(f"{h:g}", f"{rows.speed[at]:.0f} rpm", *list(found.values())[:3])


def by_stretch(rows: Rows) -> None:
    """ch3, one lag each: what is left in each stretch of one speed of the locked part, about the fitted level."""
    cut = int(np.searchsorted(rows.t_h, CUT_H))
    y = rows.ch[3]
    alone = search(y, [rows.speed], [slice(0, cut)]).left
    both = search(y, [rows.speed, rows.t[4]], [slice(0, cut)]).left
    head("hours", "speed [rpm]", "ch3 measured [um]", "speed alone leaves [um]", "with t4 leaves [um]", "t4 [degC]")
    switched = np.flatnonzero(np.abs(np.diff(rows.speed)) > 100) + 1
    ends = [cut, *(int(i) for i in switched if i > cut + 10), len(y)]
    for a, b in itertools.pairwise(ends):
        if b - a < 10:
            continue
        cells = (f"{x[a:b].mean():+.1f}" for x in (y, alone, both))
        row(
            f"{rows.t_h[a]:.1f}-{rows.t_h[b - 1]:.1f}",
            f"{np.median(rows.speed[a:b]):.0f}",
            *cells,
            f"{rows.t[4][a:b].mean():.1f}",
        )


def more_lags(rows: Rows) -> None:
    """Two lags a driver, searched; and of ch3 another sensor in place of t4, and a third driver beside speed and t4."""
    cut = int(np.searchsorted(rows.t_h, CUT_H))
    told = ("trained", "fitted level", "own mean", "first 10 min")
    head("probe", "drivers", "time constants [min]", "gains [um/rpm, um/K]", *told)
    cases: list[tuple[int, tuple[int, ...], int]] = [(ch, drivers, 2) for ch in PROBES for drivers in ((), (4,))]
    cases += [(3, (k,), 1) for k in (11, 12, 14)] + [(3, (4, k), 1) for k in (7, 9, 11, 14)]
    for ch, sensors, lags in cases:
        fit = search(rows.ch[ch], [rows.speed, *(rows.t[k] for k in sensors)], [slice(0, cut)], lags)
        name = ", ".join(["speed", *(f"t{k}" for k in sensors)]) + (", two lags each" if lags > 1 else "")
        row(
            f"ch{ch}",
            name,
            taus(fit),
            ", ".join(f"{g:.3g}" for g in fit.gains),
            rms(fit.left[:cut]),
            *list(scores(fit.left, cut).values())[:3],
        )


def swing(rows: Rows) -> None:
    """What each probe does at the period at which t4 swings most, beside what one lag of t4 lets through."""
    half, cut = (int(np.searchsorted(rows.t_h, h)) for h in (HALF_H, CUT_H))
    window = {"fs": 1.0, "nperseg": 300}  # [1/min], [min]
    f, power = welch(rows.t[4], **window)
    fast = (f > 1 / 60) & (f < 1 / 10)
    at = int(np.flatnonzero(fast)[np.argmax(power[fast])])
    head("probe", "period [min]", "coherence with t4", "measured [um/K]", "one lag of t4 [um/K]", "its tau [min]")
    for ch in PROBES:
        fit = search(rows.ch[ch], [rows.speed, rows.t[4]], [slice(0, half), slice(half, cut)])
        tau, gain = fit.taus_min[1][0], fit.gains[1]
        through = abs(gain) / np.hypot(1, 2 * np.pi * f[at] * tau)
        response = csd(rows.t[4], rows.ch[ch], **window)[1][at] / power[at]
        alike = coherence(rows.t[4], rows.ch[ch], **window)[1][at]
        row(f"ch{ch}", f"{1 / f[at]:.0f}", float(alike), float(abs(response)), float(through), f"{tau:.0f}")


def main() -> None:
    rows = read()
    for table in (levels, banks, other_cuts, by_stretch, more_lags, swing):
        table(rows)


if __name__ == "__main__":
    main()
