"""Whether what was told of claims, such as their error on the locked tests, is of a version of a model."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.errors import UsageError
from thermodata.modelling.inputs.roles import fitted_keys, resolve_roles
from thermodata.modelling.versions.candidate import with_candidate
from thermodata.schema.diagnosis import Diagnosis
from thermodata.schema.model import EffectSpec, Model
from thermodata.view.dataset import Dataset


def is_fit_with_claims(spec: Model, data: Dataset, earlier: Model, found: Diagnosis) -> bool:
    """Whether a model is the fit that the claims of an earlier version were confirmed in: on the same data, with these
    effects and no other, fitted to the same open tests beside the same locked ones. found: the answer with the
    claims."""
    put_right = found.put_right
    if found.data_version != data.data_version or (put_right is not None and put_right.clocks):
        return False  # with clocks moved, the logs were others
    left_out = set(put_right.left_out) if put_right is not None else set()
    then, now = resolve_roles(earlier, data), resolve_roles(spec, data)
    return (
        {*fitted_keys(spec, now)} == {*then.calibrate, *then.verify} - left_out
        and {*now.locked} == {*then.locked} - left_out
        and _effects_with_claims(data, earlier, found) == _bare(spec.effects)
    )


def _effects_with_claims(data: Dataset, earlier: Model, found: Diagnosis) -> list[str] | None:
    """None where one is of effects or channels that are gone since."""
    try:
        for claim in (c for c in found.candidates if c.claimed):
            earlier = with_candidate(earlier, claim.id, data.channels)
    except UsageError:
        return None
    return _bare(earlier.effects)


def _bare(effects: Sequence[EffectSpec]) -> list[str]:
    """In no order, and without ids, which differ by the order in which effects were added."""
    return sorted(e.model_copy(update={"id": None}).model_dump_json() for e in effects)
