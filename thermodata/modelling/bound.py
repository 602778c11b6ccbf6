"""Effects and responses that stand on channels: what a model file means on the data at hand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from thermodata.errors import unknown_name
from thermodata.modelling import prediction
from thermodata.modelling.drivers import has_drivers, make_drivers
from thermodata.modelling.lead import columns, with_lead
from thermodata.modelling.roles import Key
from thermodata.plugin import Bool1D, Drivers, Effect, Float2D
from thermodata.schema.model import EffectSpec
from thermodata.view.dataset import TestData

OF_TESTS = ("test", "machine", "campaign")  # what a gain can differ by, beside conditions
KEPT_TESTS = 1024  # drivers a term keeps; changed copies of tests count too


@dataclass(frozen=True)
class BoundTerm:
    """An effect on its channels. bindings: campaign -> role -> channel or expression (names may differ)."""

    id: str
    effect: Effect
    spec: EffectSpec
    bindings: Mapping[str, Mapping[str, str]]
    family: str
    only: frozenset[Key] | None = None  # the tests it exists in; None: all
    calibrate: frozenset[Key] | None = None  # identified on these first, then held
    _drivers: dict[int, tuple[TestData, Drivers, tuple[Drivers, int]]] = field(
        default_factory=dict, repr=False, compare=False
    )

    @property
    def binding(self) -> Mapping[str, str]:
        return next(iter(self.bindings.values()), {})

    def covers(self, test: TestData) -> bool:
        return self.only is None or test.key in self.only

    def has(self, test: TestData) -> bool:
        """Whether the test has what the term reads (a term that does not cover a test needs nothing there)."""
        if not self.covers(test):
            return True
        if isinstance(self.effect, prediction.Prediction):
            return self.effect.has(test)
        return has_drivers(test, self._binding_of(test))

    def drivers(self, test: TestData) -> Drivers:
        """What the effect sees of the test."""
        return self._kept(test)[1]

    def _kept(self, test: TestData) -> tuple[TestData, Drivers, tuple[Drivers, int]]:
        """Made once a test; a changed copy of a test is another test."""
        kept = self._drivers.get(id(test))
        if kept is None or kept[0] is not test:
            if len(self._drivers) >= KEPT_TESTS:
                self._drivers.clear()
            drivers = make_drivers(test, self.effect, self._binding_of(test))
            kept = self._drivers[id(test)] = (test, drivers, with_lead(drivers))
        return kept

    def columns(self, test: TestData, params: Mapping[str, float]) -> Float2D:
        """shape (n, gains); zeros where the term does not cover the test."""
        if not self.covers(test):
            return np.zeros((len(test.t_s), len(self.effect.gains)))
        if isinstance(self.effect, prediction.Prediction):
            return self.effect.column(test)
        return columns(self.effect, self._kept(test)[2], params)

    def known(self, test: TestData) -> Bool1D | None:
        """Where all drivers were measured, or nearly; None: everywhere."""
        if not self.covers(test):
            return None
        if isinstance(self.effect, prediction.Prediction):
            return np.isfinite(self.effect.column(test)[:, 0])
        if not self.effect.needs:
            return None
        masks = list(self.drivers(test).valid.values())
        out = masks[0].copy()
        for mask in masks[1:]:
            out &= mask
        return out

    def group(self, test: TestData) -> str:
        """The value that its gain belongs to ('' where one gain serves all)."""
        by = self.spec.gain_by
        if by is None:
            return ""
        value = group_of(test, by)
        if value is None:
            raise unknown_name(
                "condition",
                by.removeprefix("conditions."),
                [*test.conditions, *OF_TESTS],
                where=f"gain_by of effect '{self.id}', test {test.campaign}/{test.test}",
            )
        return value

    def _binding_of(self, test: TestData) -> Mapping[str, str]:
        found = self.bindings.get(test.campaign)
        return self.binding if found is None else found


def group_of(test: TestData, by: str) -> str | None:
    """The value of a `gain_by` in a test; None where the test has no such condition."""
    if by in OF_TESTS:
        return str(getattr(test, by))
    value = test.conditions.get(by.removeprefix("conditions."))
    return f"{value:g}" if isinstance(value, float | int) else None if value is None else str(value)


@dataclass(frozen=True)
class BoundResponse:
    """name: its channel (in the first campaign); channels: campaign -> channel."""

    name: str
    unit: str
    channels: Mapping[str, str]
    terms: tuple[BoundTerm, ...]
    units: Mapping[str, str] = field(default_factory=dict)  # of every channel, by name

    def channel_of(self, test: TestData) -> str:
        return self.channels.get(test.campaign, self.name)
