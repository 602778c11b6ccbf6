"""How far a model carries over to other machines: the gain g, and the class by the rule of [straka2021]."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Literal

import numpy as np

from thermodata.modelling.inputs.phases import phases
from thermodata.modelling.predictions.score import fit_percent, peak_sum, role_of
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse, has_response
from thermodata.plugin import Bool1D, Float1D
from thermodata.view.grid.dataset import Dataset, TestData

Verdict = Literal["portable", "with_correction", "not_portable", "x"]
END_S = 1800.0  # the end of heating is a mean over this long


@dataclass(frozen=True)
class Portability:
    """One test. g: least squares through the zero of the first samples, as the FITs are taken, so that it never makes
    them worse; g_end: from the end of heating (one point: noisier). fit_* [%], ptp_* [response's
    unit] as printed in [straka2021] (|max| + |min|): measured, residual without (n) and with (c) the gain. verdict "x"
    where it can't be predicted, for a sensor is missing on that machine: `why` says which. role: in the model, such as
    'verification (in-sample)' where it was fitted too; of a test of another campaign, which took no part in it, as
    that campaign has it."""

    campaign: str
    test: str
    machine: str
    role: str
    response: str
    g: float | None = None
    g_end: float | None = None
    fit_n: float | None = None
    fit_c: float | None = None
    ptp_measured: float | None = None
    ptp_n: float | None = None
    ptp_c: float | None = None
    verdict: Verdict = "x"
    why: str | None = None

    def to_json(self) -> dict[str, object]:
        return asdict(self)


def portability(fitted: FittedModel, data: Dataset) -> list[Portability]:
    """A row a test and response, over all tests that have the response, of whatever role but locked."""
    rows: list[Portability] = []
    for test in data.tests:
        own = test.campaign in fitted.spec.campaign_ids
        role = role_of(fitted, test) if own else test.role
        if role == "locked":
            continue
        for response in fitted.responses:
            why = response.why_not(test)
            if why is not None and has_response(response.bound, test):
                rows.append(Portability(test.campaign, test.test, test.machine, role, response.name, why=why))
            elif why is None and response.mask(test).any():
                rows.append(_portability(response, test, role))
    return rows


def classify(
    g: float | None, fit_n: float | None, fit_c: float | None, ptp_measured: float, ptp_n: float, ptp_c: float
) -> Verdict:
    """Portable: |g - 1| <= 0.1, uncorrected FIT > 80 and the peak to peak falls. Not portable: no g, g outside
    0.33..3, corrected FIT < 20, or the peak to peak rises. Else with correction. Source: [straka2021]."""
    if g is None or not math.isfinite(g) or fit_c is None:
        return "not_portable"
    # a printed gain of 1.1 is 1.1, whatever its binary fraction
    if abs(g - 1.0) <= 0.1 + 1e-9 and fit_n is not None and fit_n > 80 and ptp_n < ptp_measured:
        return "portable"
    if g < 0.33 or g > 3.0 or fit_c < 20 or ptp_c > ptp_measured:
        return "not_portable"
    return "with_correction"


def gain_least_squares(measured: Float1D, predicted: Float1D) -> float | None:
    """g of measured = g predicted, both from their zero; None where the prediction does not move."""
    power = float(predicted @ predicted)
    moves = float(np.var(predicted)) * len(predicted) > 1e-12 * max(1, len(predicted))
    return float(predicted @ measured) / power if moves else None


def _portability(response: FittedResponse, test: TestData, role: str) -> Portability:
    mask = response.mask(test)
    measured, predicted = response.measured(test), response.predict(test)
    first = mask & (test.t_s < test.t_s[np.argmax(mask)] + max(test.zero_s, 1e-9))
    y, p = measured - measured[first].mean(), predicted - predicted[first].mean()
    g = gain_least_squares(y[mask], p[mask])
    corrected = y - (1.0 if g is None else g) * p
    plain = y - p
    numbers = (peak_sum(y[mask]), peak_sum(plain[mask]), peak_sum(corrected[mask]))
    fit_n, fit_c = fit_percent(y[mask], plain[mask]), fit_percent(y[mask], corrected[mask])
    return Portability(
        test.campaign,
        test.test,
        test.machine,
        role,
        response.name,
        g,
        _end_of_heating(response, test, mask, y, p),
        fit_n,
        fit_c,
        *numbers,
        classify(g, fit_n, fit_c, *numbers),
    )


def _end_of_heating(response: FittedResponse, test: TestData, mask: Bool1D, y: Float1D, p: Float1D) -> float | None:
    masks = phases(test, response.bound.channel_of(test))
    warm = [masks[name] for name in ("heating", "steady") if name in masks]
    if not warm:
        return None
    last = np.flatnonzero(np.logical_or.reduce(warm) & mask)
    if not len(last):
        return None
    end = mask & (test.t_s > test.t_s[last[-1]] - END_S) & (test.t_s <= test.t_s[last[-1]])
    below = float(p[end].mean()) if end.any() else 0.0
    return float(y[end].mean()) / below if abs(below) > 1e-9 else None
