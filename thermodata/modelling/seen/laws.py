"""The laws of a fitted response: each term as formulas with its parameters and gains put in.

What has no law belongs to the tests it was fitted to (a slip, another program's numbers), or to an effect whose author
did not write one; `TermLaw.why_not` says which.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from thermodata.calibration.expression import nodes
from thermodata.calibration.expression.parser import parse
from thermodata.effect import law
from thermodata.errors import UsageError, unknown_name
from thermodata.modelling.inputs.drivers import ZERO_AT_REST, names_of
from thermodata.modelling.model_file.nested import ModelOutput
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm, Values
from thermodata.modelling.terms.of_tests import OfTests
from thermodata.modelling.terms.parameters import gain_unit
from thermodata.schema.units.unit import difference_unit
from thermodata.view.grid.dataset import ChannelInfo


@dataclass(frozen=True)
class Drive:
    """What drives a role: a channel, or an expression of channels. relative: it counts from the start."""

    role: str
    text: str
    tree: law.Node
    relative: bool
    unit: str


@dataclass(frozen=True)
class GainLaw:
    """One gain with what it multiplies. tree: names are roles; parameters are put in, times in s."""

    name: str
    value: float
    unit: str
    tree: law.Node


@dataclass(frozen=True)
class TermLaw:
    """One effect of the model. why_not: why there is no law, else None. parameters: name -> (value, unit). choices: of
    which group it is asked, where that is all that is missing."""

    id: str
    effect: str
    equation: str
    group: str
    drives: Mapping[str, Drive]
    parameters: Mapping[str, tuple[float, str]]
    gains: tuple[GainLaw, ...]
    why_not: str | None = None
    choices: tuple[str, ...] = ()


def laws(
    response: FittedResponse,
    channels: Mapping[str, ChannelInfo],
    step_s: float,
    groups: Mapping[str, str] | None = None,
    campaign: str | None = None,
) -> tuple[TermLaw, ...]:
    """Every term of a response. channels: of the data, by name. step_s: of the model's grid [s]. groups: id of an
    effect -> value of its gain_by; UsageError for an unknown one. campaign: whose names the channels have (default:
    the first)."""
    given = dict(groups or {})
    for name in given:
        if name not in [t.id for t in response.terms]:
            raise unknown_name("effect", name, [t.id for t in response.terms], where="--group")
    return tuple(_law(response, term, channels, step_s, given.get(term.id), campaign) for term in response.terms)


def _law(
    response: FittedResponse,
    term: FittedTerm,
    channels: Mapping[str, ChannelInfo],
    step_s: float,
    wanted: str | None,
    campaign: str | None,
) -> TermLaw:
    effect, binding = term.effect, term.bound.bindings.get(campaign or "", term.binding)
    group, why = _group(term, wanted)
    values = term.groups.get(group) or next(iter(term.groups.values()))
    choices = tuple(term.groups) if why is not None and _why_not(term) is None else ()
    why = _why_not(term) or why
    drives: dict[str, Drive] = {}
    gains: tuple[GainLaw, ...] = ()
    if why is None and isinstance(effect, ModelOutput):
        drives, gains, why = _law_of_output(effect, values, laws(effect.response, channels, step_s, None, campaign))
    elif why is None:
        try:
            drives = {role: _drive(term, channels, role, text) for role, text in binding.items()}
            gains = _gains(response, term, values, set(binding), step_s)
        except UsageError as error:
            why = " ".join(str(error).split())
    return TermLaw(
        term.id,
        effect.name,
        getattr(effect, "equation", "") or effect.meaning,
        group,
        drives,
        {p.name: (values.params[p.name], p.unit) for p in effect.params if p.name not in values.silent},
        gains,
        why,
        choices,
    )


def _gains(
    response: FittedResponse, term: FittedTerm, values: Values, roles: set[str], step_s: float
) -> tuple[GainLaw, ...]:
    effect = term.effect
    formulas = effect.law(roles, values.params, step_s)  # type: ignore[attr-defined]
    units = {p.name: p.unit for p in effect.params}
    return tuple(
        GainLaw(
            gain.name,
            float(values.gains[gain.name]),
            gain_unit(response, term, gain.unit),
            law.with_parameters(formula, values.params, units),
        )
        for gain, formula in zip(effect.gains, formulas, strict=True)
    )


def _law_of_output(
    effect: ModelOutput, values: Values, terms: Sequence[TermLaw]
) -> tuple[dict[str, Drive], tuple[GainLaw, ...], str | None]:
    """Another model's output: its terms, each times the factor on it."""
    drives: dict[str, Drive] = {}
    gains: list[GainLaw] = []
    factor = float(values.gains[effect.gains[0].name])
    for term in terms:
        if term.why_not is not None:
            return {}, (), f"in the model inside it, {term.id}: {term.why_not}"
        names = {role: f"{term.id}_{role}" for role in term.drives}
        drives |= {names[role]: replace(drive, role=names[role]) for role, drive in term.drives.items()}
        renamed: dict[str, law.Node] = {role: law.Symbol(name) for role, name in names.items()}
        gains += [
            GainLaw(f"{term.id}.{g.name}", factor * g.value, g.unit, law.put(g.tree, renamed)) for g in term.gains
        ]
    return drives, tuple(gains), None


def _group(term: FittedTerm, wanted: str | None) -> tuple[str, str | None]:
    by = " and ".join(term.bound.spec.gains_by)
    if wanted is not None:
        if wanted not in term.groups:
            raise unknown_name(f"group of {term.id}", wanted, list(term.groups), where=f"gain_by: {by or 'none'}")
        return wanted, None
    if len(term.groups) == 1:
        return next(iter(term.groups)), None
    return "", f"its gain differs by {by} ({', '.join(term.groups)}): --group {term.id}={next(iter(term.groups))}"


def _why_not(term: FittedTerm) -> str | None:
    if isinstance(term.effect, ModelOutput):
        return None
    if isinstance(term.effect, OfTests):
        return "its numbers are another program's for these tests: it has no drivers"
    if term.bound.only is not None:
        named = ", ".join("/".join(k) for k in sorted(term.bound.only))
        return f"it exists in some tests only ({named})"
    if term.bound.spec.phases is not None:
        phases = ", ".join(term.bound.spec.phases)
        return f"it acts in phases only ({phases}), which a control is not told: spindle_heating_cooling has the switch"
    stated = getattr(term.effect, "not_in_control", None)
    if stated:
        return str(stated)
    if not hasattr(term.effect, "law"):
        return f"the effect '{term.effect.name}' states no law, the formula that is computed from sample to sample"
    return None


def _drive(term: FittedTerm, channels: Mapping[str, ChannelInfo], role: str, text: str) -> Drive:
    names = names_of(text)
    units = {n: c.unit for n, c in channels.items()}
    need = next((n.quantity for n in term.effect.needs if n.role == role), "*")
    tree = law.Symbol(text) if text.isidentifier() else from_expression(parse(text).tree, text)
    logical = not text.isidentifier() and parse(text).logical
    at_rest = all(n in channels and channels[n].quantity in ZERO_AT_REST for n in names)
    unit = units.get(text, "1") if text.isidentifier() else parse(text).unit({n: units.get(n, "1") for n in names})
    relative = not at_rest and not logical and need != "position"
    return Drive(role, text, tree, relative, difference_unit(unit or "1") if relative else unit or "1")


def from_expression(node: nodes.Node, text: str) -> law.Node:
    """An expression of channels as a law's tree. UsageError where it holds a unit: a control has none."""

    def of(one: nodes.Node) -> law.Node:
        match one:
            case nodes.Constant(value, unit):
                if unit:
                    raise UsageError(
                        f"the driver '{text}' holds a unit, which a control does not know",
                        got=f"{value:g} {unit}",
                        hint="write the number in the channel's own unit, without a unit",
                    )
                return law.Number(value)
            case nodes.Name(name):
                return law.Symbol(name)
            case nodes.Negative(inner):
                return law.Binary("*", law.Number(-1.0), of(inner))
            case nodes.Absolute(inner):
                return law.Absolute(of(inner))
            case nodes.Arithmetic(operator, left, right):
                return law.Binary(operator, of(left), of(right))
            case nodes.Comparison(operands, operators):
                trees = [of(o) for o in operands]
                pairs = [law.Compare(op, trees[i], trees[i + 1]) for i, op in enumerate(operators)]
                return pairs[0] if len(pairs) == 1 else law.Logic("and", tuple(pairs))
            case nodes.Every(parts):
                return law.Logic("and", tuple(map(of, parts)))
            case nodes.AnyOf(parts):
                return law.Logic("or", tuple(map(of, parts)))
            case nodes.Not(inner):
                return law.Logic("not", (of(inner),))
        raise TypeError(type(one))

    return law.fold(of(node))


def refuse_unlawful(terms: Sequence[TermLaw], where: str) -> None:
    """UsageError that names every term without a law, why, and what to do about it."""
    bad = [t for t in terms if t.why_not is not None]
    if bad:
        asked = " ".join(f"--group {t.id}={t.choices[0]}" for t in bad if t.choices)
        out = ",".join(t.id for t in bad if not t.choices)
        leave = f"--without {out} leaves {'it' if ',' not in out else 'them'} out" if out else ""
        raise UsageError(
            "not all of the model can run in a control",
            where=where,
            got="; ".join(f"{t.id}: {t.why_not}" for t in bad),
            hint=" ".join(filter(None, [asked and f"{asked} chooses its gain;" if leave else asked, leave]))
            if asked or len(bad) < len(terms)
            else "add an effect that has drivers, and leave these out",
        )
