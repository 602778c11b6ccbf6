"""Candidates that change an effect of the model instead of adding one: other gains, other functions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.errors import SpecError
from thermodata.modelling.inputs.drivers import names_of
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.plugin import Drivers, Float2D, Gain, Need, Param
from thermodata.view.grid.dataset import TestData

# what else a gain may be, as a share of the one gain: by machine, wear or preload; soft (`evidence.BEYOND`)
TIMES = (0.1, 3.0)


@dataclass(frozen=True, slots=True)
class EffectOfModel:
    """A fitted effect as a candidate sees it: its name and drivers; what is asked of it, a subclass says."""

    fitted: FittedTerm

    @property
    def name(self) -> str:
        return self.fitted.effect.name

    @property
    def family(self) -> str:
        return self.fitted.family

    @property
    def meaning(self) -> str:
        return self.fitted.effect.meaning

    @property
    def source(self) -> str:
        return self.fitted.effect.source

    @property
    def needs(self) -> tuple[Need, ...]:
        return self.fitted.effect.needs

    @property
    def params(self) -> tuple[Param, ...]:
        return ()

    @property
    def gains(self) -> tuple[Gain, ...]:
        return ()

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        """Raises SpecError: what it does depends on the test, see `CandidateEffect.in_test`."""
        raise SpecError(f"{self.name} as a part of the model is asked by tests, not by drivers")


@dataclass(frozen=True, slots=True, kw_only=True)
class ChangedEffect(CandidateEffect, ABC):
    """An effect of the model, otherwise than it is: always a refinement, never a missing cause."""

    term: FittedTerm

    @property
    def channels(self) -> tuple[str, ...]:
        """That drive the effect, and no expressions of them."""
        return tuple(dict.fromkeys(n for text in self.binding.values() for n in names_of(text)))

    @property
    def within(self) -> str:
        return self.term.id

    def in_tests(self, tests: Sequence[TestData], points: Sequence[Mapping[str, float]]) -> list[Float2D]:
        """See `CandidateEffect.in_tests`; test by test, for what it does is no basis of drivers alone."""
        each = [self.in_test(test) for test in tests]
        return [np.concatenate([at(p) for p in points], axis=1) for at in each]

    @abstractmethod
    def in_words(self, scored: Scored) -> str:
        """How it acts otherwise, as found beside all that was chosen."""

    def in_version(self, version: Callable[[], FittedResponse], tests: Sequence[TestData]) -> str | None:
        """The same by a version that has it, fitted to these tests; None where that tells no more."""
        return None


def is_free(term: FittedTerm) -> bool:
    """Whether its gains are fitted to all tests. What was identified on tests of its own has no gain for the others,
    and an ARX function has none."""
    spec = term.bound.spec
    free = any(g.name not in spec.fixed for g in term.effect.gains)
    return not term.held and free and bool(term.effect.needs) and spec.method != "arx"
