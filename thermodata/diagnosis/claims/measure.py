"""What claims are measured against: the response, its noise, and what chance finds in it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Float1D

FLOOR_SHARE = 0.1  # a residual under this share of the response (FIT 90) is left alone
# what lags leave of a distributed machine that lacks nothing is under this share of its response (FIT 75), or, where
# modes of the model are found that refine it, what they leave under that (FIT 60); what is left where a cause is
# missing is more (docs/method.md#verdicts)
GOOD_SHARE, REFINED_SHARE = 0.25, 0.4
# the short-term noise, so many times, is nothing but noise, for there is a slow one, too: up to the share of the
# response that is left alone anyway; above that a noise that is large by itself in the means that are compared
NOISE_TIMES, LARGE_NOISE_TIMES = 5.0, 2.0


@dataclass(frozen=True, slots=True)
class Measure:
    """What claims are measured against. spread: RMS of the response about its offsets. noise: its short-term noise.
    chance: the best evidence of chance, shape (draws,). in_parts: whether tests are so few that they are cut into parts
    in time, of which each is left out in turn. averaged: samples in each mean that left-out tests are compared by."""

    spread: float
    noise: float
    chance: Float1D
    in_parts: bool = False
    averaged: int = 1

    @property
    def tests(self) -> str:
        """What is left out in turn, in a word."""
        return "parts" if self.in_parts else "tests"

    @property
    def noises(self) -> float:
        """An error of left-out tests that is nothing but noise."""
        return self._noises(self.averaged)

    @property
    def floor(self) -> float:
        """An error of left-out tests that is left alone: noise, and what lags leave of a distributed machine."""
        return self._floor(self.averaged)

    @property
    def floor_of_samples(self) -> float:
        """The same of errors that are taken sample by sample, as on locked tests."""
        return self._floor(1)

    @property
    def said(self) -> float:
        """An error on locked tests that says nothing: no more than noise and what is left alone of a response. Noise
        that is large by itself hides no fall of what is more than it."""
        noise = self.noise if np.isfinite(self.noise) else 0.0
        return min(self.floor_of_samples, float(np.hypot(noise, FLOOR_SHARE * self.spread)))

    def good(self, *, refined: bool) -> float:
        """An error that a good model has. refined: that it has once its effects are refined."""
        return max(self.floor, (REFINED_SHARE if refined else GOOD_SHARE) * self.spread)

    def _floor(self, averaged: int) -> float:
        return max(self._noises(averaged), FLOOR_SHARE * self.spread)

    def _noises(self, averaged: int) -> float:
        """Of means of so many samples."""
        if not np.isfinite(self.noise):
            return 0.0
        large = LARGE_NOISE_TIMES * self.noise / math.sqrt(averaged)
        return max(large, min(NOISE_TIMES * self.noise, FLOOR_SHARE * self.spread))
