"""What each effect gives in several models, beside each other on one test, from what their fits stored.

Fits of one campaign hang together in a way that nobody stored. So a difference of two contributions is told with the
sum of both half widths: whatever the correlation, sd(a - b) <= sd(a) + sd(b). It leaves out zero exactly where the two
bands that are drawn are apart.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.errors import UsageError, unknown_name
from thermodata.plugin import Float1D
from thermodata.schema.agreed.certainty import Z95
from thermodata.view.curves.predictions import Prediction, predictions
from thermodata.view.curves.residuals import Key, predicted_tests

if TYPE_CHECKING:
    from thermodata.store import Store

_SAME = 0.005  # of the largest contribution on the page: less is no difference


@dataclass(frozen=True, slots=True)
class Peak:
    """Where a curve is farthest from zero: t_s [s] from the test's start, value in the response's unit. low, high:
    95 %, None where the fit stored no deviation."""

    t_s: float
    value: float
    low: float | None
    high: float | None


@dataclass(frozen=True, slots=True)
class ContributionsApart:
    """One model's contribution less that of the pinned one, an effect that a model lacks counting as zero. curve,
    reach: shape (n,), reach is half of at least 95 % (None where a deviation is not known). peak: the largest
    difference. apart_s: for how long the two bands are apart [s], None where one is not known."""

    curve: Float1D
    reach: Float1D | None
    peak: Peak
    apart_s: float | None


@dataclass(frozen=True, slots=True)
class Effect:
    """curves, deviations, peaks: one a model, in their order; shape (n,); None where a model lacks the effect, or where
    its fit stored no deviation. apart: of each model but the pinned one. differs: whether any is apart from it."""

    effect: str
    curves: tuple[Float1D | None, ...]
    deviations: tuple[Float1D | None, ...]
    peaks: tuple[Peak | None, ...]
    apart: tuple[ContributionsApart, ...]
    differs: bool


@dataclass(frozen=True, slots=True)
class Contributions:
    """Of one response in one test. models: ids of those that predict it, the pinned one first. t_s: shape (n,), the
    pinned one's own times. effects: those of the pinned one first, in the order of its file."""

    campaign: str
    test: str
    response: str
    models: tuple[str, ...]
    t_s: Float1D
    effects: tuple[Effect, ...]

    def to_json(self) -> list[dict[str, Any]]:
        """A row an effect and model: what it gives at most, and how far that is from the pinned one."""
        return [
            {
                "campaign": self.campaign,
                "test": self.test,
                "response": self.response,
                "effect": effect.effect,
                "model": model,
                "against": self.models[0] if i else None,
                "largest": None if (peak := effect.peaks[i]) is None else asdict(peak),
                "difference": asdict(effect.apart[i - 1].peak) if i else None,
                "apart_s": effect.apart[i - 1].apart_s if i else None,
                "differs": effect.differs,
            }
            for effect in self.effects
            for i, model in enumerate(self.models)
        ]


def open_test(store: Store, model: str, name: str) -> tuple[str, str]:
    """(campaign, test) of an open test that the model predicts. name: TEST, or CAMPAIGN/TEST where two campaigns have
    it. UsageError for a test that there is not."""
    known = predicted_tests(store, model)
    found = [(c, t) for c, t in known if name in (t, f"{c}/{t}")]
    if not found:
        raise unknown_name("test", name, [t for _, t in known], where=f"model {model}: tests with a stored prediction")
    if len(found) > 1:
        told = ", ".join(f"{c}/{t}" for c, t in found)
        raise UsageError(f"several campaigns have a test '{name}'", expected=told, got=name)
    return found[0]


def test_names(keys: Sequence[Key], beside: Iterable[str]) -> dict[Key, str]:
    """The name by which `open_test` finds each: TEST, or CAMPAIGN/TEST where they are of several campaigns. beside:
    campaigns whose tests stand on the same page."""
    several = len({c for c, _ in keys} | set(beside)) > 1
    return {(c, t): f"{c}/{t}" if several else t for c, t in keys}


def contributions(store: Store, models: Sequence[str], campaign: str, test: str) -> list[Contributions]:
    """One for each response that the first of the models predicts in this test; nothing is computed but differences,
    and no locked test has a stored prediction. models: ids, at least one."""
    by_model = {m: {p.response: p for p in predictions(store, m, campaign, test)} for m in models}
    found = []
    for response, pinned in by_model[models[0]].items():
        there = {m: known[response] for m, known in by_model.items() if response in known}
        found.append(_contributions_beside(pinned, there))
    return found


def _contributions_beside(pinned: Prediction, there: Mapping[str, Prediction]) -> Contributions:
    curves = {m: _at_times(pinned.t_s, p, p.contributions) for m, p in there.items()}
    deviations = {m: _at_times(pinned.t_s, p, p.deviations) for m, p in there.items()}
    names = dict.fromkeys(name for known in curves.values() for name in known)
    sizes = [float(np.nanmax(np.abs(y), initial=0.0)) for known in curves.values() for y in known.values()]
    effects = tuple(
        _effect(
            name,
            pinned.t_s,
            tuple(known.get(name) for known in curves.values()),
            tuple(deviations[m].get(name) if name in curves[m] else None for m in curves),
            _SAME * max(sizes, default=0.0),
        )
        for name in names
    )
    return Contributions(pinned.campaign, pinned.test, pinned.response, tuple(there), pinned.t_s, effects)


def _at_times(t_s: Float1D, p: Prediction, known: Mapping[str, Float1D]) -> dict[str, Float1D]:
    """On the pinned one's times; NaN beyond what the model predicts."""
    if np.array_equal(t_s, p.t_s):
        return dict(known)
    return {n: np.interp(t_s, p.t_s, y, left=np.nan, right=np.nan) for n, y in known.items()}


def _effect(
    name: str,
    t_s: Float1D,
    curves: tuple[Float1D | None, ...],
    deviations: tuple[Float1D | None, ...],
    least: float,
) -> Effect:
    # what a model lacks is exactly nothing
    nothing = np.zeros(len(t_s))
    reaches = [
        nothing if y is None else None if sd is None else Z95 * sd for y, sd in zip(curves, deviations, strict=True)
    ]
    values = [nothing if y is None else y for y in curves]
    peaks = tuple(None if y is None else _peak(t_s, y, r) for y, r in zip(curves, reaches, strict=True))
    apart = tuple(
        _differences(t_s, y - values[0], None if r is None or reaches[0] is None else r + reaches[0], least)
        for y, r in zip(values[1:], reaches[1:], strict=True)
    )
    differs = any(abs(a.peak.value) > least and a.apart_s != 0 for a in apart)
    return Effect(name, curves, deviations, peaks, apart, differs)


def _differences(t_s: Float1D, curve: Float1D, reach: Float1D | None, least: float) -> ContributionsApart:
    peak = _peak(t_s, curve, reach)
    if reach is None:
        return ContributionsApart(curve, None, peak, None)
    step = float(np.median(np.diff(t_s))) if len(t_s) > 1 else 0.0
    return ContributionsApart(
        curve, reach, peak, step * int(np.count_nonzero(np.abs(curve) > np.maximum(reach, least)))
    )


def _peak(t_s: Float1D, y: Float1D, reach: Float1D | None) -> Peak:
    if not np.isfinite(y).any():
        return Peak(0.0, 0.0, None, None)
    at = int(np.nanargmax(np.abs(y)))
    value = float(y[at])
    if reach is None:
        return Peak(float(t_s[at]), value, None, None)
    return Peak(float(t_s[at]), value, value - float(reach[at]), value + float(reach[at]))
