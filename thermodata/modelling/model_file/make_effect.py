"""What an entry of a model file stands for: an effect of a plugin, or one that the file itself spells out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import cast

from thermodata.effect import effect as find_effect
from thermodata.errors import PluginError, SpecError, UsageError
from thermodata.modelling.model_file import nested
from thermodata.modelling.model_file.prediction import as_effect as prediction
from thermodata.modelling.model_file.transfer import as_effect as transfer
from thermodata.plugin import Effect
from thermodata.schema.agreed.effect_ids import ids_of
from thermodata.schema.files.model import EffectSpec, Model

_OWNED = {
    "method": transfer.NAME,
    "orders": transfer.NAME,
    "delay": transfer.NAME,
    "file": prediction.NAME,
    "name": nested.NAME,
    "gain": nested.NAME,
    "parts": nested.NAME,
}


def refuse_unknown_effects(spec: Model) -> None:
    """UsageError, or PluginError, for an effect that no installed plugin has, with the model that needs it: it may have
    been fitted where the plugin was."""
    ids = ids_of((e.effect, e.id) for e in spec.effects)
    for name, effect in zip(ids, spec.effects, strict=True):
        if effect.effect not in (nested.NAME, prediction.NAME, transfer.NAME):
            try:
                find_effect(effect.effect)
            except (UsageError, PluginError) as error:
                raise error.at(f"model '{spec.name}', effect '{name}'") from error


def make_effect(
    spec: EffectSpec,
    where: str,
    base: Path | None,
    response: Mapping[str, str] | None = None,
    unit: str | None = None,
) -> Effect:
    """The plugin's effect, or one of the two that the model file itself spells out. response: campaign -> the channel
    that it acts on, in `unit`."""
    if spec.effect == transfer.NAME:
        function = transfer.given(spec.fixed, where)
        if function is not None:
            return cast(Effect, function)
        if spec.delay is not None and spec.method != "arx":
            raise SpecError(
                "'delay' belongs to method arx", where=f"effect '{where}'", hint="also: [dead_time], in seconds"
            )
        return cast(Effect, transfer.FreeFunction(spec.method or "varpro", spec.orders or (2, 2)))
    if spec.effect == prediction.NAME:
        if spec.file is None:
            raise SpecError(
                "an effect 'prediction' needs 'file'",
                where=where,
                expected="file: theirs.csv",
                hint="write the other model's prediction as CSV with the columns test, t_s, predicted, and "
                "name that file",
            )
        return cast(Effect, prediction.read_prediction((base or Path()) / spec.file, response, unit))
    for key, owner in _OWNED.items():
        if getattr(spec, key) is not None:
            hint = f"an effect is called by 'id: {spec.name}'" if key == "name" else None
            raise SpecError(f"'{key}' belongs to {owner}", where=f"effect '{where}', {spec.effect}", hint=hint)
    return find_effect(spec.effect)
