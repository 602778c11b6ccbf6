"""What a fit says about one effect: what drives it, how long its lags are, and what its sensors' steps do."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from thermodata.effect.guard import guarded_basis
from thermodata.modelling.inputs.drivers import names_of
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.schema.answers.result import Check
from thermodata.view.grid.dataset import TestData

LAGS_APART = 1.5  # ratio of two time constants of one effect
UNSURE = 1.0  # standard deviation of log(tau) that says nothing
RIPPLE = 1.0  # of the prediction within a sample, in the response's unit


def own_channel(response: FittedResponse, term: FittedTerm, tests: Sequence[TestData]) -> list[Check]:
    """A response among the drivers of its own effect: it explains itself, whatever the machine does."""
    for test in tests:
        own = response.bound.channel_of(test)
        read = [text for text in term.bound.binding_of(test).values() if own in names_of(text)]
        if read and term.bound.covers(test):
            return [
                Check(
                    name=f"own_channel:{term.id}",
                    value=None,
                    threshold=None,
                    passed=False,
                    advice=f"'{term.id}' of '{own}' is driven by '{own}' itself, which explains it whatever the "
                    "machine does: drive it by another channel, or say with acts_on which responses it acts on",
                )
            ]
    return []


def longer_than_record(term: FittedTerm, tests: Sequence[TestData]) -> list[Check]:
    """Time constants that are longer than the longest test that it acts in."""
    covered = [t for t in tests if term.bound.covers(t) and len(t.t_s)]
    if term.held and term.bound.calibrate is not None:
        return []
    record = max((float(t.t_s[-1] - t.t_s[0]) for t in covered), default=0.0) / 60.0
    rows = []
    for param in term.effect.params:
        if param.unit == "min" and param.name.startswith("tau") and record > 0:
            value = term.params[param.name]
            if value > record:
                rows.append(
                    Check(
                        name=f"tau_longer_than_record:{term.id}.{param.name}",
                        value=value,
                        threshold=record,
                        passed=False,
                        advice="the time constant is longer than the longest test: only gain/tau is known",
                    )
                )
    return rows


def lags_apart(term: FittedTerm) -> list[Check]:
    """Whether the data tell the several time constants of one effect."""
    taus = [p.name for p in term.effect.params if p.name.startswith("tau")]
    if len(taus) < 2 or term.effect.family == "ambient":
        return []
    values = sorted(term.params[n] for n in taus)
    ratio = min(b / a for a, b in pairwise(values))
    unsure = max((term.sd.get(n, 0.0) for n in taus), default=0.0)
    passed = ratio > LAGS_APART and unsure < UNSURE
    return [
        Check(
            name=f"lags_apart:{term.id}",
            value=ratio,
            threshold=LAGS_APART,
            passed=passed,
            advice="the lags are apart" if passed else "the data does not identify that many lags: take one fewer",
        )
    ]


def ripple(response: FittedResponse, term: FittedTerm, tests: Sequence[TestData]) -> list[Check]:
    """What one step of a coarse sensor does to the prediction within a sample."""
    rows = []
    infos = {n: i for t in tests for n, i in t.channels.items()}
    for role, text in term.binding.items():
        sizes = [infos[n].resolution for n in names_of(text) if n in infos]
        resolution = max((r for r in sizes if r), default=0.0)
        test = next((t for t in tests if term.bound.covers(t) and term.bound.has(t)), None)
        if resolution <= 0 or test is None:
            continue
        drivers = term.bound.drivers(test)
        step = np.zeros(len(test.t_s))
        step[len(step) // 2 :] = resolution
        pulse = type(drivers)(
            drivers.t_s,
            {r: step if r == role else np.zeros_like(step) for r in drivers.values},
            drivers.valid,
            drivers.conditions,
        )
        jump = guarded_basis(term.effect, pulse, term.params) @ np.array(
            [term.gains[g.name] for g in term.effect.gains]
        )
        moves = float(np.max(np.abs(np.diff(jump)), initial=0.0))
        rows.append(
            Check(
                name=f"quantisation_ripple:{term.id}",
                value=moves,
                threshold=RIPPLE,
                passed=moves <= RIPPLE,
                advice=f"one step of {text} ({resolution:g}) moves the prediction "
                f"by {moves:.2g} {response.unit} within a sample",
            )
        )
    return rows
