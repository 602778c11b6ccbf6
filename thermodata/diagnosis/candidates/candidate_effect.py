"""A candidate: an effect on the channels that would drive it, and what is known of it before any data."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.candidates.kin import Kin
from thermodata.diagnosis.question.present import TIME_UNITS
from thermodata.effect.binding import candidate_id
from thermodata.modelling.inputs.drivers import has_drivers
from thermodata.modelling.inputs.lead import columns, columns_of_each, led_drivers
from thermodata.modelling.versions.candidate import with_effect
from thermodata.plugin import Drivers, Effect, Float2D
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import TestData

InTest = Callable[[Mapping[str, float]], Float2D]  # parameters -> columns of a test, shape (n, gains)
# a distributed machine also acts with these multiples of an effect's time constant
SLACK_FACTORS = (0.2, 5.0)


@dataclass(frozen=True, slots=True)
class CandidateEffect:
    """An effect and the channels it would be driven by. family: with the axis that its channels sit on.
    placeless: nobody declared where any temperature sits, so it can only be a plain lag. passive: no effect has a name
    for it, and it reads the temperature of a casting, of what stands beside the machine, or one of which nobody
    declared where it sits, while others have a place. log_prior: how much less probable than others before any data.
    kin: how near it is to what the model has already (`Kin`). unforetold: why left-out tests can't be asked of it; None
    where they can. unread: places of other parts that it may be (`unread`). around: whether it reads nothing
    but one temperature of the air, the floor or the outside. of_motion: whether it reads nothing but motions.
    of_holder: whether it reads the temperature of what holds the probes, or of the tool, which warm with all in the
    working space. of_source: whether it reads nothing but temperatures of parts that make heat of their own, and store
    it. lesser: whether it is the part of an axis that moves the tool less as a rule, and `unread` has the
    other. unmodelled: of a plain function, ids of what has a name by the same channels, and of whose heat the model has
    nothing."""

    effect: Effect
    binding: Mapping[str, str]
    family: str
    placeless: bool = False
    passive: bool = False
    log_prior: float = 0.0
    kin: Kin = None
    unforetold: str | None = None
    unread: tuple[str, ...] = ()
    around: bool = False
    of_motion: bool = False
    of_holder: bool = False
    of_source: bool = False
    lesser: bool = False
    unmodelled: tuple[str, ...] = ()

    @property
    def channels(self) -> tuple[str, ...]:
        return tuple(self.binding.values())

    @property
    def id(self) -> str:
        return candidate_id(self.effect.name, self.binding)

    @property
    def within(self) -> str | None:
        """The effect of the model that it changes; None where it is an effect more."""
        return None

    @property
    def becomes(self) -> tuple[str, ...]:
        """The ids of what that effect is in a model with it."""
        return ()

    @property
    def gain_by(self) -> str | None:
        """The condition that its gain differs by."""
        return None

    @property
    def phases(self) -> tuple[str, ...]:
        """The phases that it acts in by functions of their own."""
        return ()

    @property
    def protocol(self) -> str | None:
        """The test that tells it from others; None where its channels say that (`next_test`)."""
        return None

    def added_to(self, spec: Model) -> Model:
        """A model with it."""
        return with_effect(spec, EffectSpec(effect=self.effect.name, drivers=dict(self.binding)))

    def in_test(self, test: TestData) -> InTest:
        """What it does in a test; zero where the test lacks a channel, or its sensor failed: nothing is known there. It
        is zero, too, where its drivers rest (`plugin.Effect.basis`)."""
        led = self._led_drivers_in(test)
        if led is None:
            nothing = np.zeros((len(test.t_s), len(self.effect.gains)))
            return lambda p: nothing
        return lambda p: columns(self.effect, led, p)

    def in_tests(self, tests: Sequence[TestData], points: Sequence[Mapping[str, float]]) -> list[Float2D]:
        """The same in each of several tests, at several points side by side: shape (n, points * gains) each."""
        led = [self._led_drivers_in(test) for test in tests]
        found = iter(columns_of_each(self.effect, [one for one in led if one is not None], points))
        width = len(points) * len(self.effect.gains)
        return [
            np.zeros((len(t.t_s), width)) if one is None else next(found) for t, one in zip(tests, led, strict=True)
        ]

    def _led_drivers_in(self, test: TestData) -> tuple[Drivers, int] | None:
        """What drives it in a test; None where it does nothing there."""
        failed = any(n in test.channels and test.channels[n].faulty is not None for n in self.channels)
        if failed or not has_drivers(test, self.binding):
            return None
        drivers, led = led_drivers(test, self.effect, self.binding)
        return led if any(values.any() for values in drivers.values.values()) else None

    def slack_params(self, p: Mapping[str, float]) -> list[dict[str, float]]:
        """The parameters of the same effect acting faster and slower (see `known_effects.otherwise`)."""
        return [
            {**p, param.name: p[param.name] * factor}
            for param in self.effect.params
            if param.unit in TIME_UNITS
            for factor in SLACK_FACTORS
        ]
