"""Locked tests that hold the recording of an open one under another name: what was fitted to foretells itself there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.schema.diagnosis import Artefact
from thermodata.view.dataset import TestData

LEAST_SAMPLES = 30  # that are equal to the last digit, and not all one value


def copies(locked: Sequence[TestData], opened: Sequence[TestData], response: str) -> list[tuple[TestData, TestData]]:
    """(locked test, open one) of each whose displacement is the same at the same times."""
    pairs = ((one, next((o for o in opened if same_recording(one, o, response)), None)) for one in locked)
    return [(one, other) for one, other in pairs if other is not None]


def same_recording(one: TestData, other: TestData, response: str) -> bool:
    """Whether two tests have the same values of a response, at all times of theirs: noise is never the same."""
    if not all(response in t.values for t in (one, other)) or len(one.t_s) != len(other.t_s):
        return False
    a, b = one.values[response], other.values[response]
    known = np.isfinite(a)
    enough = int(known.sum()) >= LEAST_SAMPLES and float(np.ptp(a[known])) > 0
    return enough and np.array_equal(one.t_s, other.t_s) and np.array_equal(a, b, equal_nan=True)


def as_artefacts(found: Sequence[tuple[TestData, TestData]], response: str) -> list[Artefact]:
    return [
        Artefact(
            kind="copy",
            campaign=one.campaign,
            test=one.test,
            at_s=None,
            size_um=None,
            why=f"'{response}' has the same values here as in the open test '{other.test}', to the last digit: it is "
            "the same recording, and confirms nothing. It was left out of the locked tests; take one of the two out of "
            "the campaign file, or give this one the recording of another day",
        )
        for one, other in found
    ]
