"""A candidate of a diagnosis as a line of a model file: 'feed_screw:T_nut_Z' -> effect and drivers."""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.effect import effect as find_effect
from thermodata.effect.binding import Described, bindings
from thermodata.errors import UsageError, unknown_name
from thermodata.schema.model import EffectSpec, Model


def candidate_spec(candidate: str, channels: Mapping[str, Described]) -> EffectSpec:
    """Channels stand in the order of the effect's roles. UsageError where effect or channels are unknown or unfit."""
    name, _, rest = candidate.partition(":")
    effect = find_effect(name)
    given = [c.strip() for c in rest.split(",") if c.strip()]
    for channel in given:
        if channel not in channels:
            raise unknown_name("channel", channel, list(channels), where=f"candidate '{candidate}'")
    choices = bindings(effect, channels)
    fitting = [c for c in choices if list(c.values()) == given or not given]
    if len(fitting) == 1:
        return EffectSpec(effect=name, drivers=dict(fitting[0]))
    if len(given) == len(effect.needs):  # a channel without a place, named on purpose
        return EffectSpec(effect=name, drivers={n.role: c for n, c in zip(effect.needs, given, strict=True)})
    raise UsageError(
        f"candidate '{candidate}' fits {len(fitting) or 'no'} sets of channels",
        expected=", ".join(f"{name}:{','.join(c.values())}" for c in choices) or "an effect that fits",
    )


def with_effect(spec: Model, effect: EffectSpec) -> Model:
    """A new model: the same, and one effect more. Verification tests take part in the choice, so they are fitted too
    and their scores say so."""
    return spec.model_copy(update={"effects": [*spec.effects, effect], "in_sample": True})
