"""Locked tests that hold the recording of an open one under another name, or a part of it: what was fitted to foretells
itself there."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.diagnosis.question.once import same_recording
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.view.grid.dataset import TestData
from thermodata.view.grid.shared_samples import shared_samples


def copies(locked: Sequence[TestData], opened: Sequence[TestData], response: str) -> list[tuple[TestData, TestData]]:
    """(locked test, open one) of each whose displacement is the same at the same times, or that have samples of one
    recording in common."""

    def again(one: TestData, other: TestData) -> bool:
        return same_recording(one, other, response) or shared_samples(one, other, response) is not None

    pairs = ((one, next((o for o in opened if again(one, o)), None)) for one in locked)
    return [(one, other) for one, other in pairs if other is not None]


def as_artefacts(found: Sequence[tuple[TestData, TestData]], response: str) -> list[Artefact]:
    """found: (a test, the one that it repeats)."""
    return [
        Artefact(
            kind="copy",
            campaign=one.campaign,
            test=one.test,
            at_s=None,
            size_um=None,
            why=_why_left_out(one, other, response),
        )
        for one, other in found
    ]


def _why_left_out(one: TestData, other: TestData, response: str) -> str:
    name = other.test if other.campaign == one.campaign else "/".join(other.key)
    span = None if same_recording(one, other, response) else shared_samples(one, other, response)
    if span is not None:
        return (
            f"{span[0] / 3600:.3g} to {span[1] / 3600:.3g} h of it are samples of the open test '{name}', cut from the "
            "same recording: it confirms nothing. It was left out of the locked tests; give the two windows that do "
            "not overlap, or this one the recording of another day"
        )
    return (
        f"'{response}' has the same values here as in the open test '{name}', to the last digit: it is "
        "the same recording, and confirms nothing. It was left out of the locked tests; take one of the two out of "
        "the campaign file, or give this one the recording of another day"
    )
