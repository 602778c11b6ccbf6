"""Verification and locked tests that hold samples which the model is fitted to: they confirm nothing."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from thermodata.modelling.inputs.roles import Key, Roles
from thermodata.schema.answers.result import Check
from thermodata.view.grid.dataset import Dataset, TestData
from thermodata.view.grid.shared_samples import shared_samples


@dataclass(frozen=True, slots=True)
class Overlap:
    """with_test: (campaign, test) that the model is fitted to. from_s, to_s: what is shared, from the test's start."""

    with_test: Key
    from_s: float
    to_s: float


def overlaps(
    data: Dataset, roles: Roles, fitted_to: Sequence[Key], channels: Sequence[Callable[[TestData], str]]
) -> dict[Key, Overlap]:
    """Verification or locked test -> the fitted one of whose samples it has some. channels: of responses, in a test."""
    kept_out = [data.test(*key) for key in (*roles.verify, *roles.locked) if key not in fitted_to]
    others = [data.test(*key) for key in fitted_to]
    found: dict[Key, Overlap] = {}
    for test in kept_out:
        for other in others:
            for channel in channels:
                span = shared_samples(test, other, channel(test), channel(other))
                if span is not None and test.key not in found:
                    found[test.key] = Overlap(other.key, *span)
    return found


def overlap_checks(found: Mapping[Key, Overlap], roles: Roles) -> list[Check]:
    """What a fit says of each."""
    return [
        Check(
            name=f"overlap:{'/'.join(key)}",
            value=(one.to_s - one.from_s) / 3600,
            threshold=0.0,
            passed=False,
            advice=f"{one.from_s / 3600:.3g} to {one.to_s / 3600:.3g} h of this {roles.role(key)} test are samples of "
            f"{'/'.join(one.with_test)}, which the model is fitted to: it confirms nothing. Give them windows that do "
            "not overlap, or one of them another role",
        )
        for key, one in found.items()
    ]
