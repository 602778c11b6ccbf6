"""Fitted models that leave given residuals, where a test asks what is done with a fit and not how it is made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thermodata.plugin import Bool1D, Float1D
from thermodata.schema.answers.result import Check, Parameter
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset, TestData


@dataclass
class Response:
    """A fitted response that leaves given residuals. left: by test; what can't be predicted is absent."""

    left: dict[str, Float1D]
    unit: str = "um"
    terms: tuple[Any, ...] = ()
    name: str = "dZ"
    checks: tuple[Check, ...] = ()

    def can_predict(self, test: TestData) -> bool:
        return self.why_not(test) is None

    def why_not(self, test: TestData) -> str | None:
        return None if test.test in self.left else f"no '{self.name}'"

    def residual(self, test: TestData) -> Float1D:
        return self.left[test.test]

    def measured(self, test: TestData) -> Float1D:
        return 10.0 * np.sin(np.arange(len(test.t_s)))

    def mask(self, test: TestData) -> Bool1D:
        return test.in_window


@dataclass
class Fitted:
    responses: list[Response]
    spec: Model
    given: Sequence[TestData] = ()
    locked: Sequence[TestData] = ()
    values: dict[str, Parameter] = field(default_factory=dict)

    def tests(self, data: Dataset, *roles: str) -> list[TestData]:
        return list(self.locked if roles == ("locked",) else self.given)

    def parameters(self) -> dict[str, Parameter]:
        return self.values
