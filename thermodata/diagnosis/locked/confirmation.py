"""What locked tests say of candidates: errors with and without them, by test, as scored and by shape."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from thermodata.diagnosis.weigh.foretold import Foretold
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.schema.answers.result import Parameter


@dataclass(frozen=True, slots=True)
class Shape:
    """Of one locked test, a free offset: sums of squares of the error before and after, and of what is changed, in the
    square of the response's unit. key: campaign and test. rows: samples that count."""

    key: tuple[str, str]
    rows: int
    before: float
    after: float
    changed: float


@dataclass(frozen=True, slots=True)
class Confirmation:
    """Errors on the locked tests in the response's unit, None where there are none; parameters of the added effects, by
    candidate.

    before, after: as scored, from the mean of the first samples on. shape_before, shape_after: with a free offset a
    test: one unlucky zero must not hide that the shape fits. All are of fits to all open tests. stands: as scored, of
    the model as it is fitted to its own tests, which is what somebody has; None where it was not asked, or the refit
    leaves as much (`confirm.AS_REFITTED`). stands_each: the same of every locked test, by its key. changed: RMS of what
    the addition changes there. each: (key, error before, error after) of every locked test. shapes: of every one, too.
    asked: the keys of those that decide, for a claim acts there; None: all. acts: the keys of those in which the
    candidates themselves act, fitted beside the model as it stands (`ACTS`). does: how much they do in each, about its
    mean. most: in the open test in which they do most. implausible: what is said of gains that are larger than anything
    known, by candidate. fitted: with the candidates, to all open tests.
    """

    before: float | None
    after: float | None
    shape_before: float | None
    shape_after: float | None
    changed: float
    parameters: dict[str, dict[str, Parameter]]
    each: tuple[tuple[tuple[str, str], float, float], ...] = ()
    shapes: tuple[Shape, ...] = ()
    asked: frozenset[tuple[str, str]] | None = None
    acts: frozenset[tuple[str, str]] = frozenset()
    does: Mapping[tuple[str, str], float] = field(default_factory=dict)
    most: float | None = None
    implausible: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    fitted: FittedResponse | None = None
    stands: float | None = None
    stands_each: Mapping[tuple[str, str], float] = field(default_factory=dict)

    def on(self, tests: frozenset[tuple[str, str]] | None) -> Foretold | None:
        """By shape, on some of the locked tests; None where none of them can be predicted."""
        if tests is None:
            return self.foretold
        return foretold_by([s for s in self.shapes if s.key in tests], tests)

    @property
    def foretold(self) -> Foretold | None:
        """By shape; None where there are no locked tests."""
        before, after = self.shape_before, self.shape_after
        return None if before is None or after is None else Foretold(before, after, self.changed)

    @property
    def where_it_acts(self) -> Foretold | None:
        """By shape, on the locked tests in which the candidates act; None where they rest in all of them."""
        return self.on(self.acts)


def foretold_by(shapes: Sequence[Shape], tests: frozenset[tuple[str, str]] | None) -> Foretold | None:
    """By the shapes of some tests, whose keys `tests` are (None: all); None where these have no samples."""
    rows = sum(s.rows for s in shapes)
    if not rows:
        return None
    before, after, changed = (
        float(np.sqrt(sum(getattr(s, name) for s in shapes) / rows)) for name in ("before", "after", "changed")
    )
    return Foretold(before, after, changed, tests=tests, rows=rows)
