"""A model of the store beside the tests that it was fitted to and checked on, where more came since: what these say of
it (how its parameters spread, what it leaves on unseen tests) is what they said then."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.run import Loaded
from thermodata.schema.answers.result import FitResult, Parameter

if TYPE_CHECKING:
    from thermodata.store import Store

SAME = 1e-3  # relative: what a fit that was made again differs by


def on_its_tests(store: Store, model: Loaded) -> Loaded:
    """The same model, fitted again to what it was fitted to, without the calibration and verification tests that came
    later; as it is where none did, where its data changed, and where it no longer comes out as the store has it."""
    from thermodata.store.catalogue.models.fits import find_model

    stored = find_model(store, model.identity)
    if not model.kept or stored.stale:
        return model
    spec = stored.spec
    then = {(s.campaign, s.test) for s in stored.result.scores}
    named = {*(spec.calibrate_on or ()), *(spec.verify_on or ()), *(n for e in spec.effects for n in _tests_of(e))}
    tests = tuple(
        t
        for t in model.data.tests
        if t.key in then or t.role not in ("calibration", "verification") or {t.test, "/".join(t.key)} & named
    )
    data = replace(model.data, tests=tests)
    fitted = fit_model(spec, data)
    if not _comes_out_again(stored.result, fitted.parameters()):
        return model
    return replace(model, fitted=fitted, data=data, kept=False)


def _tests_of(effect: object) -> list[str]:
    return list(getattr(effect, "calibrate_on", None) or ()) + list(getattr(effect, "tests", None) or ())


def _comes_out_again(kept: FitResult, now: dict[str, Parameter]) -> bool:
    """Whether all parameters are those of the store."""
    there = {n: p.value for n, p in kept.parameters.items()}
    return there.keys() == now.keys() and all(_are_close(v, now[n].value) for n, v in there.items())


def _are_close(a: float | None, b: float | None) -> bool:
    return a == b if a is None or b is None else math.isclose(a, b, rel_tol=SAME, abs_tol=1e-9)
