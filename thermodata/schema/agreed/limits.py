"""Limits that the rules of a verdict and the sentences about it share."""

from __future__ import annotations

PLAUSIBLE = 0.3
"""A sound candidate of this probability contradicts that nothing is missing, though it is not claimed."""
OF_NOTHING = 0.5
"""What lags leave of a machine that lacks nothing is mostly under this share of its response, so that beyond it more is
missing for sure: 13 to 47 % on 25 of 26 such machines (docs/method.md#verdicts)."""
NOISY = 1.5
"""An error up to so many times the short-term noise is noise."""
CLAIMS_ASK = (0.65, 0.5)
"""Probabilities that a claim asks: where places are declared, and where none is (`claims/probability.py`)."""
