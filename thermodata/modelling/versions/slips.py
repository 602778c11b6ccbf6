"""What belongs to one test, as a line of a model file: 'step:t05' takes the steps that were told of test t05 out."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.effect import effects
from thermodata.errors import UsageError
from thermodata.modelling.inputs.roles import find_tests, in_full
from thermodata.schema.answers.diagnosis import Artefact, Diagnosis
from thermodata.schema.answers.slip_ids import STEP, slip_ids, slips_of
from thermodata.schema.files.model import EffectSpec, Model, Response
from thermodata.view.grid.dataset import Dataset


def lines_of_test(
    candidate: str, spec: Model, data: Dataset, found: Diagnosis | None, names: Sequence[str]
) -> list[EffectSpec]:
    """The lines that 'EFFECT:TEST' means, for an effect of a probe's own (a slip, a drift); empty where the id names
    another effect. found: the stored diagnosis, which tells when the probe slipped, and how far. names: of the
    model's responses, in its order.

    UsageError where no test is named, or no slip was told of it."""
    name, _, named = candidate.partition(":")
    effect = effects().get(name)
    if effect is None or effect.family != "artefact":
        return []
    steps = slips_of(found) if found is not None else []
    told = ", ".join(slip_ids(found)) if found is not None else ""
    if not named.strip():
        raise UsageError(
            f"'{name}' is a fault of one probe in one test",
            expected=told if told and name == STEP else f"{name}:TEST",
            got=candidate,
            hint="name the test in which it happened",
        )
    test = find_tests([named.strip()], data, f"candidate '{candidate}'")
    if name != STEP:
        return [EffectSpec(effect=name, tests=in_full(test))]
    own = [r for r, n in zip(spec.responses, names, strict=True) if found is not None and n == found.response]
    lines = [_of_step(a, spec, own, in_full(test)) for a in steps if (a.campaign, a.test) in test]
    if not lines:
        asked = spec.name if found is None else found.model
        raise UsageError(
            f"no step was told of test '{named.strip()}'",
            expected=told or "a step that diagnose tells",
            got=candidate,
            hint=f"thermodata diagnose {asked}; or write the line into the model file: {{effect: step, tests: "
            f"[{named.strip()}], fixed: {{at: 90 min}}}}",
        )
    return lines


def with_lines(spec: Model, lines: list[EffectSpec]) -> Model:
    """The model with these lines too. No test took part in their choice but the one that each belongs to."""
    return spec.model_copy(update={"effects": [*spec.effects, *lines]})


def _of_step(told: Artefact, spec: Model, own: list[Response], test: list[str]) -> EffectSpec:
    """With the size that was told: while an effect is missing, a step of a free size is fitted to that effect. Where
    the responses share time constants no line may leave one out, so each has a size of its own there."""
    moment = {"at": f"{(told.at_s or 0.0) / 60.0:.6g} min"}
    if any("place" in e.gains_by for e in spec.effects):
        return EffectSpec.model_validate({"effect": STEP, "tests": test, "fixed": moment, "gain_by": "place"})
    only = {"acts_on": own} if len(spec.responses) > 1 else {}
    size = float(f"{told.size_um or 0.0:.3g}")
    return EffectSpec.model_validate({"effect": STEP, "tests": test, "fixed": {**moment, "gain": size}, **only})
