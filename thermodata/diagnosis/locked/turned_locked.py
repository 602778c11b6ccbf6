"""Locked tests in which the probe's sign is turned: they refuse what all open tests say, and are foretold turned round.

Only what the open tests claim foretells them, so nobody asks before a claim has opened the lock.
"""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.diagnosis.locked.confirm import shape_of
from thermodata.modelling.predictions.score import fit_percent
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.modelling.terms.rms import rms
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.view.grid.dataset import TestData

# [%] of the test, turned round: what only runs the other way (a day that cools, where the others warm) is no mirror
# image
LEAST_FIT = 70.0


def turned_locked(claimed: FittedResponse, locked: Sequence[TestData], floor: float) -> dict[tuple[str, str], float]:
    """Key -> FIT [%] of each locked test as the model foretells it turned round, where it is so. claimed: with all that
    was refused, fitted to the open tests. floor: RMS that is left alone, in the response's unit."""
    found = {}
    for test in locked:
        if not claimed.can_predict(test):
            continue
        mask = claimed.mask(test)
        measured = claimed.measured(test)
        said = shape_of(measured - claimed.residual(test), test, mask)
        is_there = shape_of(measured, test, mask)
        if not len(said) or rms([is_there]) <= floor:
            continue
        upright, turned = (fit_percent(is_there, is_there - sign * said) for sign in (1, -1))
        if upright is not None and upright < 0 and turned is not None and turned >= LEAST_FIT:
            found[test.key] = turned
    return found


def as_artefacts(found: dict[tuple[str, str], float], response: str) -> list[Artefact]:
    """found: locked tests that are turned -> their FIT [%] turned round."""
    return [
        Artefact(
            kind="sign",
            campaign=campaign,
            test=test,
            at_s=None,
            size_um=None,
            why=f"turned round, this locked test is as the model with what the open tests claim foretells it (FIT "
            f"{share:.0f}): its sign is wrong. It was left out of the locked tests; check on which side the probe "
            "stood, and give the test a calibration of its own (in the campaign file, below tests: channels: "
            f"{response}: calibration)",
        )
        for (campaign, test), share in found.items()
    ]
