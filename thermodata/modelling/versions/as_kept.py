"""A fitted model as the store kept it: its parameters are read and never looked for again, whatever became of its data.

The tests have the roles that they had in the fit; what came since is new to it, and what is locked now stays shut.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import cast

from thermodata.errors import UsageError
from thermodata.modelling.fit.arx import ArxFunction
from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.inputs.overlap import overlaps
from thermodata.modelling.inputs.roles import Key, Roles, fitted_keys, in_full
from thermodata.modelling.model_file.resolve import resolve
from thermodata.modelling.model_file.transfer.as_effect import DIRECT, NAME, FreeFunction
from thermodata.modelling.terms.bound import BoundResponse, BoundTerm
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FACTOR, FittedResponse, FittedTerm, Values
from thermodata.plugin import Effect
from thermodata.schema.answers.result import SAMPLE, Check, FitResult
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import Dataset, TestData

IN_SAMPLE = " (in-sample)"
Told = Mapping[str, float]
"""Parameter -> value, of one term: as `parameters` names them, without the term's id."""


def as_kept(spec: Model, result: FitResult, data: Dataset, *, changed: bool = True) -> FittedModel:
    """The model of a stored result on the data as they are now. changed: the tests of the fit are not as they were, or
    not all there; else there are only more. UsageError where its parameters are not all stored (a model inside of one
    whose data changed), and where no test that it was fitted to is left."""
    spec = _on_what_is_left(spec, _roles(spec, result, data), data)

    def not_kept(inside: Model) -> FittedModel:
        if not changed:
            of_fit = {(s.campaign, s.test) for s in result.scores}
            return fit_model(
                inside, replace(data, tests=tuple(t for t in data.tests if t.key in of_fit)), uncertainty=False
            )
        raise UsageError(
            f"the data of '{spec.name}' have changed, and the store has not what the model '{inside.name}' inside of "
            "it was fitted to",
            where=f"model '{spec.name}' ({result.model})",
            hint=f"thermodata fit {result.model}",
        )

    roles, bound = resolve(spec, data, None, not_kept)
    fitted_on = {*fitted_keys(spec, _roles_then(result))}
    several = len(bound) > 1
    return FittedModel(
        spec,
        roles,
        tuple(
            _response(b, result, f"{b.name}/" if several else "", spec, roles, frozenset(fitted_on & _keys(data)))
            for b in bound
        ),
        overlaps=overlaps(data, roles, sorted(fitted_on & _keys(data)), [b.channel_of for b in bound]),
    )


def _roles_then(result: FitResult) -> Roles:
    role = {(s.campaign, s.test): s.role.removesuffix(IN_SAMPLE) for s in result.scores}
    return Roles(*(tuple(k for k, own in role.items() if own == r) for r in ("calibration", "verification", "locked")))


def _keys(data: Dataset) -> set[Key]:
    return {t.key for t in data.tests}


def _roles(spec: Model, result: FitResult, data: Dataset) -> Roles:
    then = {(s.campaign, s.test): s.role.removesuffix(IN_SAMPLE) for s in result.scores}
    named = {*(spec.calibrate_on or ()), *(spec.verify_on or ())}  # of these a locked test is open on purpose
    closed = {*(spec.locked or ())}

    def role_of(t: TestData) -> str:
        own = {t.test, "/".join(t.key)}
        if own & closed or (t.role == "locked" and not own & named):
            return "locked"
        told = spec.calibrate_on if t.role == "calibration" else spec.verify_on
        return then.get(t.key, "none" if t.role == "none" or told is not None else "verification")

    role = {t.key: role_of(t) for t in data.tests}
    if not any(own == "calibration" for own in role.values()):
        raise UsageError(
            "no test that the model was fitted to is left",
            where=f"model '{result.name}' ({result.model})",
            hint=f"thermodata fit {result.model}",
        )
    each = (tuple(k for k, own in role.items() if own == r) for r in ("calibration", "verification", "locked"))
    return Roles(*each)


def _on_what_is_left(spec: Model, roles: Roles, data: Dataset) -> Model:
    """The spec with these roles, and without tests that are no more."""
    known = {name for t in data.tests for name in (t.test, "/".join(t.key))}

    def left(effect: EffectSpec) -> EffectSpec:
        named = {"tests": effect.tests, "calibrate_on": effect.calibrate_on}
        return effect.model_copy(
            update={k: [n for n in names if n in known] for k, names in named.items() if names is not None}
        )

    return spec.model_copy(
        update={
            "calibrate_on": in_full(roles.calibrate),
            "verify_on": in_full(roles.verify),
            "locked": in_full(roles.locked),
            "weights": {},  # they count in a fit only
            "effects": [left(e) for e in spec.effects],
        }
    )


def _response(
    bound: BoundResponse, result: FitResult, prefix: str, spec: Model, roles: Roles, fitted_on: frozenset[Key]
) -> FittedResponse:
    terms = []
    for term in bound.terms:
        start = f"{prefix}{term.id}."
        told = {n.removeprefix(start): p.value for n, p in result.parameters.items() if n.startswith(start)}
        terms.append(_term(term, told))
    bound = replace(bound, terms=tuple(t.bound for t in terms))
    checks = tuple(_own(c, bool(prefix)) for c in result.checks if _is_of(c, bound.name, bool(prefix)))
    wanted = None if spec.phases is None else tuple(spec.phases)
    return FittedResponse(bound, tuple(terms), wanted, frozenset(roles.calibrate), checks, fitted_on=fitted_on)


# made anew from the data, or of the model as a whole
_ANEW = ("skipped:", "not_predicted:", "not_scored:", "on_at_start:", "overlap:")


def _is_of(check: Check, response: str, several: bool) -> bool:
    if check.name.startswith(_ANEW):
        return False
    return not several or check.name.partition(":")[2].partition("/")[0] == response


def _own(check: Check, several: bool) -> Check:
    """With the name that it has where the model has one response."""
    kind, _, rest = check.name.partition(":")
    subject = rest.partition("/")[2]
    return check.model_copy(update={"name": f"{kind}:{subject}" if subject else kind}) if several else check


def _term(term: BoundTerm, told: Told) -> FittedTerm:
    term, told = _with_its_function(term, told)
    groups = dict.fromkeys(n.partition("[")[2].removesuffix("]") for n in told if n.endswith("]")) or {"": None}
    factors = [told.get(f"{FACTOR}[{group}]", 1.0) for group in groups]
    values = {}
    for group, factor in zip(groups, factors, strict=True):
        tag = f"[{group}]" if group else ""
        params = {p.name: told.get(p.name + tag, told.get(p.name, p.start)) for p in term.effect.params}
        silent = frozenset(p for p in params if p not in told and p + tag not in told)
        gains = {
            g.name: told[g.name + tag] if g.name + tag in told else told[g.name] * factor / factors[0]
            for g in term.effect.gains
        }
        values[group] = Values(params, gains, silent=silent, factor=factor)
    return FittedTerm(term, values)


def _with_its_function(term: BoundTerm, told: Told) -> tuple[BoundTerm, Told]:
    """A transfer function that was identified, with its orders as they were found."""
    if term.spec.effect != NAME or not isinstance(term.effect, FreeFunction):
        return term, told
    if SAMPLE.removeprefix(".") in told:
        a, b = _numbered(told, "a"), _numbered(told, "b")
        function = ArxFunction(a, b, told[SAMPLE.removeprefix(".")], term.id)
        rest = function.identified.gain_at_rest
        own = {n: v / rest if n.partition("[")[0] == "gain" else v for n, v in told.items()}
        return replace(term, effect=cast(Effect, function), _drivers={}), own
    names = {n.partition("[")[0] for n in told}
    taus = sum(n == "tau" or n.startswith("tau_") for n in names)
    gains = sum(n in ("gain", DIRECT) or n.startswith(("gain_", "lead_")) for n in names)
    method = term.spec.method or "varpro"
    effect = FreeFunction(method, (gains, taus))
    spec = term.spec.model_copy(update={"orders": (gains, taus)})
    return replace(term, effect=cast(Effect, effect), spec=spec, _drivers={}), told


def _numbered(told: Told, letter: str) -> Sequence[float]:
    found = {int(n[1:]): v for n, v in told.items() if n[0] == letter and n[1:].isdigit()}
    return [found[i] for i in sorted(found)]
