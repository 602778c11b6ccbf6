"""Whether what an answer told is of a version of a model: of its claims, such as their error on the locked tests, and
of what it offered."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.errors import UsageError
from thermodata.modelling.inputs.roles import fitted_keys, resolve_roles
from thermodata.modelling.versions.candidate import with_candidate
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import Dataset


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


def adds_what_was_offered(spec: Model, data: Dataset, earlier: Model, found: Diagnosis) -> bool:
    """Whether all that a model has more than an earlier one are refinements that its answer offered, by effect and
    channels: second lags of these, or of what was there, are none of their own."""
    had, offered = _kinds(earlier), set[str]()
    for one in (c for c in found.candidates if c.refinement):
        try:
            offered |= _kinds(with_candidate(earlier, one.id, data.channels)) - had
        except UsageError:
            continue  # of effects or channels that are gone since
    more = _kinds(spec) - had
    return bool(more) and more <= offered


def _kinds(spec: Model) -> set[str]:
    """What each effect is and is driven by, whatever its id, its bounds and its parameters."""
    return {e.model_dump_json(include={"effect", "drivers", "gain_by", "phases"}) for e in spec.effects}


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
