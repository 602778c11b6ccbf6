"""The zero of a response: the mean of its first valid samples, never a fit."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Bool1D, Float1D


def zero_mask(t_s: Float1D, valid: Bool1D, over_s: float) -> Bool1D:
    """The valid samples within `over_s` [s] of the first valid one; shape (n,). At least that one.

    Counted from the first valid sample and not from the start: a machine that measures for 10 s every 20 min
    may have its first value later than `over_s`.
    """
    t_s, valid = np.asarray(t_s, float), np.asarray(valid, bool)
    where = np.flatnonzero(valid)
    if not len(where):
        return np.zeros(len(t_s), bool)
    mask: Bool1D = valid & (t_s >= t_s[where[0]]) & (t_s <= t_s[where[0]] + max(over_s, 0.0))
    return mask
