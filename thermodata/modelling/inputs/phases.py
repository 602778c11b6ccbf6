"""The phases of a test: declared ones, else heating, steady and cooling from what the machine does."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Bool1D
from thermodata.view.grid.at_work import activity_channels, limits_of
from thermodata.view.grid.dataset import TestData

TOLD = ("heating", "steady", "cooling")  # where a test declares none
STEADY = 0.9  # heating ends where the response has covered this part of its way
SHORTEST_S = 600.0


def phases(test: TestData, response: str) -> dict[str, Bool1D]:
    """Name -> mask, shape (n,). Declared phases alone where there are any; empty where nothing tells them."""
    if test.phases:
        return {name: (test.t_s >= a) & (test.t_s <= b) for name, (a, b) in test.phases.items()}
    active = activity(test)
    if active is None or response not in test.values:
        return {}
    n = len(test.t_s)
    heating, steady = np.zeros(n, bool), np.zeros(n, bool)
    y = test.values[response]
    good = np.isfinite(y) & test.valid.get(response, np.ones(n, bool))
    for a, b in runs(active):
        inside = np.flatnonzero(good[a:b]) + a
        if len(inside) < 3:
            heating[a:b] = True
            continue
        way = np.abs(y[inside] - y[inside[0]])
        settled = inside[np.argmax(way >= STEADY * way.max())] if way.max() > 0 else a
        heating[a:settled] = True
        steady[settled:b] = True
    begun = np.zeros(n, bool)
    first = int(np.argmax(active))
    begun[first:] = True
    masks = dict(zip(TOLD, (heating, steady, begun & ~active), strict=True))
    return {name: mask & test.in_window for name, mask in masks.items() if (mask & test.in_window).any()}


def activity(test: TestData) -> Bool1D | None:
    """Where the machine works (spindle turns, axis feeds, power flows); None where no channel tells or none works."""
    working = np.zeros(len(test.t_s), bool)
    for name, limit in (test.at_work or limits_of([test])).items():
        if name in test.values:
            working |= np.abs(np.nan_to_num(test.values[name])) > limit
    if not working.any():
        return None
    # a pause for a measurement is no cooling phase
    step = float(test.t_s[1] - test.t_s[0]) if len(test.t_s) > 1 else 1.0
    for a, b in runs(~working):
        if a > 0 and b < len(working) and (b - a) * step < SHORTEST_S:
            working[a:b] = True
    return working


def activity_is_known(test: TestData) -> bool:
    """Whether a channel tells when the machine works, even if it never does."""
    return bool(activity_channels(test))


def runs(mask: Bool1D) -> list[tuple[int, int]]:
    """[from, to) of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
