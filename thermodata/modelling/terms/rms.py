"""The root mean square, the one measure of size that errors are told in."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.plugin import Float1D


def rms(parts: Sequence[Float1D]) -> float:
    """Of all samples of some series together, in their unit. parts: shape (n,) each, at least one sample in all."""
    return float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))


def rms_about_means(parts: Sequence[Float1D]) -> float:
    """The same of each series about its own mean."""
    return rms([part - part.mean() for part in parts])
