"""Rows of a log that are not a column's own: a recorder that writes probes every 3 s and temperatures every 30 s, each
in rows of their own, leaves the cells of the others empty. Nothing is missing there.
"""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Bool1D, Int1D

STEADY, LIKE = 0.9, 0.25  # so many of the steps between a column's values are its usual one, within a quarter
ON_BEAT = 1.5  # of the usual step: values so near to each other have none missing between them
LEAST = 20  # values that tell a beat


def rows_of_others(t_ns: Int1D, there: Bool1D, filled: Bool1D) -> Bool1D:
    """Where a column has no value because the row is another's, shape (n,), as all: its values stand around the row at
    their own steady beat. there: where it has values; filled: where any other column has."""
    own = np.flatnonzero(there)
    nothing: Bool1D = np.zeros(len(there), dtype=bool)
    if len(own) < LEAST or len(own) == len(there):
        return nothing
    steps = np.diff(t_ns[own])
    usual = float(np.median(steps))
    if usual <= 0 or float(np.mean(np.abs(steps - usual) <= LIKE * usual)) < STEADY:
        return nothing
    # before the first value and behind the last nothing tells
    near = np.concatenate([[False], steps <= ON_BEAT * usual, [False]])
    found: Bool1D = ~there & filled & near[np.searchsorted(own, np.arange(len(there)))]
    return found
