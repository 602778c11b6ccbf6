"""A fitted model: its spec, the roles of the tests, and what was fitted to each response."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from thermodata.modelling.inputs.overlap import Overlap, overlap_checks
from thermodata.modelling.inputs.roles import Key, Roles
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.modelling.terms.parameters import parameters
from thermodata.schema.answers.result import Check, Parameter
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset, TestData


@dataclass(frozen=True)
class FittedModel:
    """A model file on data: frozen, and what all is predicted from."""

    spec: Model
    roles: Roles
    responses: tuple[FittedResponse, ...]
    skipped: tuple[str, ...] = ()  # tests without the response or a driver, and why
    detail: Mapping[str, Any] = field(default_factory=dict)
    overlaps: Mapping[Key, Overlap] = field(default_factory=dict)  # tests kept out of the fit that hold fitted samples

    def parameters(self) -> dict[str, Parameter]:
        """'effect.parameter' -> value, unit and 95 % interval; 'response/effect.parameter' with several responses,
        'effect.gain[group]' with gain_by."""
        return parameters(self.responses)

    def term(self, identity: str) -> FittedTerm:
        """An effect by its id, in the first response that it acts on."""
        return next(t for response in self.responses for t in response.terms if t.id == identity)

    def checks(self) -> list[Check]:
        """With several responses each name says whose it is: 'implausible:dZ/lag.gain', 'condition_number:dZ'."""
        again = overlap_checks(self.overlaps, self.roles)
        if len(self.responses) == 1:
            return [*self.responses[0].checks, *again]
        return [
            *(
                c.model_copy(update={"name": _name_with_response(r.name, c.name)})
                for r in self.responses
                for c in r.checks
            ),
            *again,
        ]

    def tests(self, data: Dataset, *roles: str) -> list[TestData]:
        """The tests of some roles (all but locked ones and unused ones where none is named), in the data's order."""
        wanted = roles or ("calibration", "verification")
        return [t for t in data.tests if self.roles.role(t.key) in wanted]


def _name_with_response(response: str, name: str) -> str:
    """The name of a check with the response that it is of."""
    kind, _, subject = name.partition(":")
    return f"{kind}:{response}/{subject}" if subject else f"{kind}:{response}"
