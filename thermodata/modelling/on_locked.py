"""A model as it stands on the locked tests: counted as a look once a model and data; the same again is none."""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING

from thermodata.errors import UsageError, unknown_name
from thermodata.modelling.predictions.score import FEWEST, figures
from thermodata.modelling.run import Loaded, load
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.terms.rms import rms, rms_about_means
from thermodata.schema.answers.locked_error import LockedError, TestLocked
from thermodata.version import __version__

if TYPE_CHECKING:
    from thermodata.store import Store
    from thermodata.view.grid.dataset import TestData

QUESTION = "locked"  # the first word of the question whose answer is kept


def locked_errors(store: Store, ref: str, response: str | None = None) -> tuple[list[LockedError], bool]:
    """(what the model leaves on its locked tests, a row a response; whether all of it was known already).

    Nothing is fitted to more than the model was. response: only this one. UsageError for another one, and where no
    locked test can be predicted."""
    model = load(store, ref)
    names = [r.name for r in model.fitted.responses]
    if response is not None and response not in names:
        raise unknown_name("response", response, names, where="--response")
    asked = [_of_response(store, model, r) for r in model.fitted.responses if response in (None, r.name)]
    return [found for found, _ in asked], all(known for _, known in asked)


def _of_response(store: Store, model: Loaded, response: FittedResponse) -> tuple[LockedError, bool]:
    from thermodata.store.catalogue.models.findings import keep_answer, kept_answer
    from thermodata.store.catalogue.models.looks import count_locked_look, locked_looks

    question = f"{QUESTION} {response.name}"
    made_from = [model.identity, model.fitted_to, model.data.data_version, __version__]
    key = hashlib.sha256(json.dumps(made_from).encode()).hexdigest()
    kept = kept_answer(store, model.identity, question, key)
    if kept is not None:
        known = LockedError.model_validate_json(kept)
        looks = max([known.looks, *(locked_looks(store, t.campaign, t.test) for t in known.tests)])
        return known.model_copy(update={"looks": looks}), True
    tests, left_out = _usable(model, response)
    residuals = [response.residual(t)[response.mask(t)] for t in tests]
    rows = [_row(response, t) for t in tests]
    before = kept_answer(store, model.identity, question)
    shown = {} if before is None else {(t.campaign, t.test): t for t in LockedError.model_validate_json(before).tests}
    new = [(row.campaign, row.test) for row in rows if shown.get((row.campaign, row.test)) != row]
    count_locked_look(
        store, model.identity, new, f"the error of the model as it stands{_response_named(model, response)}"
    )
    found = LockedError(
        model=model.identity,
        name=model.fitted.spec.name,
        response=response.name,
        unit=response.unit,
        rmse_um=rms(residuals),
        shape_um=rms_about_means(residuals),
        tests=rows,
        left_out=left_out,
        looks=max(locked_looks(store, *t.key) for t in tests),
    )
    keep_answer(store, model.identity, question, key, found.model_dump_json())
    return found, not new


def _usable(model: Loaded, response: FittedResponse) -> tuple[list[TestData], list[str]]:
    """(locked tests that tell something, why the others don't). UsageError where none does."""
    usable, left_out = [], []
    for test in model.fitted.tests(model.data, "locked"):
        why = response.why_not(test)
        if why is None and test.key in model.fitted.overlaps:
            why = "it holds samples of a test that the model was fitted to"
        if why is None and response.mask(test).sum() < FEWEST:
            why = "none of its samples counts"
        if why is None:
            usable.append(test)
        else:
            left_out.append(f"{'/'.join(test.key)}: {why}")
    if not usable:
        raise UsageError(
            f"no locked test to tell the error of {response.name} on",
            where=f"model '{model.fitted.spec.name}' {model.identity}",
            expected="a test with role: locked, in which the model's channels were logged",
            got="; ".join(left_out) or "none: every test of the model is open",
            hint="record one more test, or take one that no model was fitted to, and write role: locked at it",
        )
    return usable, left_out


def _row(response: FittedResponse, test: TestData) -> TestLocked:
    mask = response.mask(test)
    residual = response.residual(test)[mask]
    told = figures(response.measured(test)[mask], residual)
    return TestLocked(
        campaign=test.campaign,
        test=test.test,
        rmse_um=rms([residual]),
        shape_um=rms_about_means([residual]),
        fit=told["fit"],
        ptp_um=told["ptp_um"] or 0.0,
        max_um=told["max_um"] or 0.0,
        n=len(residual),
    )


def _response_named(model: Loaded, response: FittedResponse) -> str:
    """What a look says of the response, of a model with several."""
    return f" ({response.name})" if len(model.fitted.responses) > 1 else ""
