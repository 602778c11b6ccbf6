"""The data that models are fitted to: every test of a model on one uniform grid, masks beside the values.

Plain frozen values: what makes them (from a store) is `view.grid.load`, what uses them is `modelling` and `diagnosis`.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thermodata.plugin import Bool1D, Float1D
from thermodata.view.grid.recorded import Recorded


@dataclass(frozen=True, slots=True)
class ChannelInfo:
    """A channel as the campaign file describes it. unit is canonical; sign '+' once normalised, else 'unknown'. source:
    by whose clock it was logged; None where nobody logged it (a schedule).

    lost: share of its samples in this test that flags rule out, of those that its `measuring` leaves where it declares
    one. faulty: the flag for which its sensor is judged faulty
    in this test (of a dataset: in so many that it is no witness in any); None where it is sound. clock_declared:
    whether the campaign file says how its source's clock stands (of a dataset: in all tests). is_mask: a state at no
    place that the test's `measuring` reads (of a dataset: that of any test): when it was measured, and no cause.
    scale_pct: standard (k = 1) uncertainty of its calibration's gain [%]; None where none tells it. clock_doubtful:
    whether its source's whole clock is doubtful in this test, for it could not be aligned. in_measuring: whether the
    test's `measuring` reads it. held: whether its values stand until the next one in this test: a state, or what was
    written on change.
    """

    name: str
    quantity: str
    unit: str
    at: str | None = None
    axis: str | None = None
    relative_to: str | None = None
    source: str | None = None
    sign: str = "+"
    resolution: float | None = None
    lost: float = 0.0
    faulty: str | None = None
    clock_declared: bool = False
    is_mask: bool = False
    shifted: bool = False
    scale_pct: float | None = None
    clock_doubtful: bool = False
    in_measuring: bool = False
    held: bool = False


@dataclass(frozen=True, slots=True)
class TestData:
    """One test on a uniform grid of step_s.

    t_s: shape (n,), seconds from the test's start; negative in the history before the test's window.
    values: channel -> shape (n,) float64, canonical units, mean of the valid samples of the bin (states held),
    NaN where there are none. valid: channel -> shape (n,). in_window: shape (n,), False in the history.
    conditions: numbers in canonical units or text, machine attributes included. phases: name -> (from_s, to_s).
    start_unix_s: UTC seconds of t_s == 0 (None for relative clocks), for hours of the day. recorded: channel -> where
    its samples stand in raw files. logged: channel -> the times between which its valid samples lie [s], of those at
    even steps; beyond them its value is carried on. at_work: channel -> the value beyond which the machine works, as
    all its tests tell it (`view.grid.at_work`); empty where the test stands alone. kept: what is made of this test
    alone and asked again, by who made it; a changed copy begins anew.
    """

    __test__ = False
    campaign: str
    test: str
    kind: str
    role: str
    t_s: Float1D
    values: Mapping[str, Float1D]
    valid: Mapping[str, Bool1D]
    in_window: Bool1D
    conditions: Mapping[str, float | str] = field(default_factory=dict)
    phases: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    start_state: str = "balance"
    zero_s: float = 600.0
    start_unix_s: float | None = None
    machine: str = ""
    channels: Mapping[str, ChannelInfo] = field(default_factory=dict)
    recorded: Mapping[str, Recorded] = field(default_factory=dict)
    logged: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    at_work: Mapping[str, float] = field(default_factory=dict)
    kept: dict[Hashable, Any] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def key(self) -> tuple[str, str]:
        return self.campaign, self.test

    def sampled(self, channel: str) -> Bool1D:
        """Where a channel has samples that count, shape (n,): measured, valid, and no history."""
        if channel not in self.values:
            return np.zeros(len(self.t_s), dtype=np.bool_)
        counts = np.isfinite(self.values[channel]) & self.in_window
        return counts & self.valid[channel] if channel in self.valid else counts


@dataclass(frozen=True, slots=True)
class Dataset:
    """The tests of one or more campaigns on one step. channels: the union over tests, by name. drawn_k: temperatures
    that were read in coarse steps and are drawn through them, with the step (`modelling.inputs.coarse_readings`)."""

    step_s: float
    tests: tuple[TestData, ...]
    channels: Mapping[str, ChannelInfo]
    data_version: str = ""
    drawn_k: Mapping[str, float] = field(default_factory=dict)

    def test(self, campaign: str, test: str) -> TestData:
        return next(t for t in self.tests if t.key == (campaign, test))
