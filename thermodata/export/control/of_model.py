"""From a fitted model and its data to a control program: what a reading can be, and what a correction may be."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.errors import UsageError, unknown_name
from thermodata.export.control.build import build
from thermodata.export.control.program import Input, Limits, Program, Start
from thermodata.modelling.inputs.drivers import ZERO_AT_REST, evaluate, has_drivers, most_bins, names_of, still_within
from thermodata.modelling.seen.laws import TermLaw, laws, refuse_unlawful
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.version import __version__
from thermodata.view.grid.dataset import Dataset

BEYOND_K = 30.0  # a sensor may read that much more, or less, than in any test
BEYOND = 1.5  # of the largest value, for what is zero at rest; of the range, for what is not


@dataclass(frozen=True)
class ProgramRequest:
    """What a user asks of a program, and what its head says of the model. None: as the tests say. without: ids of
    effects that are left out. fitted_to: the version of the data that the model was fitted to (default: the data's).
    stale: what changed in them since."""

    cycle_s: float = 1.0
    response: str | None = None
    name: str | None = None
    without: tuple[str, ...] = ()
    groups: Mapping[str, str] | None = None
    limit: float | None = None
    rate: float | None = None
    hold_s: float = 600.0
    fitted_to: str = ""
    stale: str | None = None


def program_of(model: str, fitted: FittedModel, data: Dataset, asked: ProgramRequest) -> Program:
    """The program of one response. model: its id. UsageError names what can't run in a control, why, and what to do."""
    response = find_response(fitted, asked.response)
    terms = laws(response, data.channels, data.step_s, asked.groups)
    known = [t.id for t in terms]
    for name in asked.without:
        if name not in known:
            raise unknown_name("effect", name, known, where="--without")
    kept = tuple(t for t in terms if t.id not in asked.without)
    if not kept:
        raise UsageError(
            "nothing is left of the model",
            where=fitted.spec.name,
            got="--without " + ",".join(known),
            hint="name fewer effects with --without",
        )
    refuse_unlawful(kept, f"model {fitted.spec.name} {model}, response {response.name}")
    inputs = inputs_of(kept, data)
    limits = _limits(response, kept, data, asked)
    info = data.channels.get(response.name)
    where = f" (axis {info.axis}, at {info.at})" if info is not None and info.axis else ""
    about = [
        ("model", f"{fitted.spec.name} {model}"),
        ("response", f"{response.name}{where} [{response.unit}]"),
        ("machine", ", ".join(dict.fromkeys(t.machine for t in data.tests if t.machine)) or "not named"),
        ("campaigns", ", ".join(fitted.spec.campaign_ids)),
        ("fitted on", ", ".join(key[1] for key in sorted(response.fitted_on))),
        ("data", (asked.fitted_to or data.data_version)[:16] or "not named"),
        *([] if asked.stale is None else [("stale", asked.stale.removeprefix("stale: "))]),
        ("step of the fit", f"{data.step_s:g} s"),
        ("cycle", f"{asked.cycle_s:g} s"),
        ("written by", f"thermodata {__version__}"),
    ]
    if asked.without:
        about.append(("left out", ", ".join(asked.without)))
    about += [("gains of", f"{t.id}: {t.group}") for t in kept if t.group]
    name = asked.name or f"{fitted.spec.name}_{response.name}"
    cycles = max(1, round(data.step_s / asked.cycle_s))
    start = Start(cycles, most_bins(cycles * asked.cycle_s))
    blank = Program(name, response.name, response.unit, asked.cycle_s, limits, tuple(about), start)
    return build(blank, kept, inputs, _bands(kept, data))


def find_response(fitted: FittedModel, name: str | None) -> FittedResponse:
    """The response of that name, or the only one. UsageError lists them."""
    names = [r.name for r in fitted.responses]
    if name is None and len(names) > 1:
        raise UsageError(
            "the model has several responses, and a program has one",
            expected=", ".join(names),
            hint=f"--response {names[0]}",
        )
    if name is not None and name not in names:
        raise unknown_name("response", name, names)
    return fitted.responses[names.index(name) if name is not None else 0]


def inputs_of(terms: Sequence[TermLaw], data: Dataset) -> dict[str, Input]:
    """Every channel that the terms read: beyond its range in all tests, with some room, a reading is bad."""
    names = dict.fromkeys(n for t in terms for d in t.drives.values() for n in names_of(d.text))
    found: dict[str, Input] = {}
    for name in names:
        info = data.channels[name]
        parts = [t.values[name][np.isfinite(t.values[name])] for t in data.tests if name in t.values]
        values = np.concatenate(parts) if parts else np.zeros(0)
        low, high = (float(values.min()), float(values.max())) if len(values) else (-1e6, 1e6)
        if info.quantity == "temperature":
            low, high = math.floor(low - BEYOND_K), math.ceil(high + BEYOND_K)
        elif info.quantity == "state":
            low, high = min(low, 0.0) - 0.5, max(high, 1.0) + 0.5
        elif info.quantity in ZERO_AT_REST:
            most = _rounded_up(BEYOND * max(abs(low), abs(high), 1e-6))
            low, high = -most, most
        else:
            room = max(BEYOND * (high - low), 1e-6)
            low, high = -_rounded_up(max(room - low, 1e-6)), _rounded_up(max(high + room, 1e-6))
        found[name] = Input(name, name, info.quantity, info.unit, float(low), float(high), info.at)
    return found


def _bands(terms: Sequence[TermLaw], data: Dataset) -> dict[str, float]:
    """Text of a drive -> how far from their mean its bins lie by noise alone in the usual test; half a step more where
    the model drew it through its steps, for a control reads these."""
    found: dict[str, float] = {}
    for text in dict.fromkeys(d.text for t in terms for d in t.drives.values() if d.relative):
        courses = [evaluate(test, text) for test in data.tests if has_drivers(test, {"": text})]
        bands = [still_within(values[good]) for values, good, _ in courses if good.any()]
        steps = sum(data.drawn_k.get(n, 0.0) for n in names_of(text))
        found[text] = (float(np.median(bands)) if bands else 0.0) + steps / 2.0
    return found


def _limits(response: FittedResponse, terms: Sequence[TermLaw], data: Dataset, asked: ProgramRequest) -> Limits:
    """Half as much again as the model moved in its tests, and twice as fast; of several gains in the tests of those
    that the program has, where there are any."""
    ids, most, fastest = {t.id for t in terms}, 0.0, 0.0
    chosen = {t.id: t.group for t in terms if t.group}
    picked = [t.bound for t in response.terms if t.id in chosen and len(t.groups) > 1]
    own = [test for test in data.tests if all(b.has(test) and b.group(test) == chosen[b.id] for b in picked)]
    for test in own or data.tests:
        if not all(term.bound.has(test) for term in response.terms if term.id in ids):
            continue
        y = np.sum([t.contribution(test) for t in response.terms if t.id in ids], axis=0)
        y = y[np.isfinite(y)]
        if len(y) > 1:
            most = max(most, float(np.abs(y).max()))
            fastest = max(fastest, float(np.abs(np.diff(y)).max()) / data.step_s * 60.0)
    limit = asked.limit if asked.limit is not None else _rounded_up(1.5 * most or 100.0)
    rate = asked.rate if asked.rate is not None else _rounded_up(2.0 * fastest or 10.0)
    for name, value in (("--limit", limit), ("--rate", rate), ("--hold", asked.hold_s)):
        if not (math.isfinite(value) and value > 0):
            raise UsageError(
                f"{name} is larger than 0",
                got=f"{value:g}",
                hint="leave it out for what the tests say",
            )
    return Limits(limit, rate, asked.hold_s)


def _rounded_up(value: float) -> float:
    """Two digits, upward."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{math.ceil(value / step - 1e-9) * step:.6g}")
