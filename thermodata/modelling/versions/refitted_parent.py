"""What fitting a model to more tests does by itself, beside what is added: a version that is fitted to its verification
tests too would leave less of them without any effect more."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from thermodata.errors import ThermodataError
from thermodata.modelling.compare.common import on_common
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.inputs.roles import fitted_keys, resolve_roles
from thermodata.modelling.predictions.score import ALL, scores
from thermodata.modelling.versions.same_tests import SAME_TESTS

if TYPE_CHECKING:
    from thermodata.modelling.terms.fitted import FittedModel
    from thermodata.schema.answers.result import Score
    from thermodata.schema.files.model import Model
    from thermodata.view.grid.dataset import Dataset


def on_the_same_tests(parent: Model, spec: Model, data: Dataset, before: Sequence[Score]) -> list[str]:
    """A note with the errors of the parent's effects where they are fitted to the tests of `spec`; none where the
    parent was fitted to all of these, or can't be. before: its scores as it was fitted."""
    if set(_fitted(spec, data)) <= set(_fitted(parent, data)):
        return []
    try:
        refitted = fit_model(spec.model_copy(update={"effects": parent.effects}), data, uncertainty=False)
    except ThermodataError:
        return []
    return [_note(refitted, *on_common([before, scores(refitted, data, "")]))]


def _fitted(spec: Model, data: Dataset) -> tuple[tuple[str, str], ...]:
    return fitted_keys(spec, resolve_roles(spec, data))


def _note(refitted: FittedModel, before: Sequence[Score], after: Sequence[Score]) -> str:
    names, told = [r.name for r in refitted.responses], []
    for response in refitted.responses:
        (was, now), (was_there, now_there) = (
            [_rmse(some, response.name, role) for some in (before, after)] for role in ("", "verification")
        )
        whose = f"of {response.name} " if len(names) > 1 else ""
        there = f", and {now_there:.3g} {response.unit} in verification instead of {was_there:.3g}"
        told.append(
            f"{whose}{now:.3g} {response.unit} over its open tests instead of {was:.3g}"
            f"{'' if math.isnan(now_there) else there}"
        )
    return f"{SAME_TESTS} leaves {'; '.join(told)}: that much comes of fitting them, only the rest of what is added"


def _rmse(some: Iterable[Score], response: str, role: str) -> float:
    """Over whole tests of a role ('': all), each sample counted once; nan where there is none."""
    rows = [s for s in some if s.phase == ALL and s.response == response and s.role.startswith(role)]
    n = sum(s.n for s in rows if s.rmse_um is not None)
    return math.sqrt(sum(s.n * (s.rmse_um or 0.0) ** 2 for s in rows) / n) if n else math.nan
