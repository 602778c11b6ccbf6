"""Whether so much of the calibration tests counts that something can be fitted, and if not, why."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from thermodata.errors import UsageError, unknown_name
from thermodata.modelling.inputs.phases import TOLD
from thermodata.view.grid.dataset import TestData


def refuse_unknown_phases(wanted: Collection[str] | None, tests: Sequence[TestData]) -> None:
    """UsageError for a phase that is declared in no test, and that nothing could tell: no sample of it would ever
    count, and nobody would say so."""
    declared = {name for test in tests for name in test.phases}
    for name in wanted or ():
        if name not in declared | set(TOLD):
            raise unknown_name("phase", name, sorted(declared | set(TOLD)), where="phases")


def refuse_too_few(response: str, tests: Sequence[TestData], counts: Sequence[int]) -> None:
    """UsageError where no test has two samples that count: each test's free offset takes one. counts: of each test."""
    got = ", ".join(f"{t.campaign}/{t.test}" for t in tests) or "no test"
    if not any(counts):
        raise UsageError(
            "no sample counts in the calibration tests",
            where=f"response '{response}'",
            got=got,
            hint="look at the response's flags (thermodata quality) and at 'phases'",
        )
    if max(counts) < 2:
        raise UsageError(
            "the model's step leaves one sample a test, and the test's free offset takes that",
            where=f"response '{response}'",
            expected="a test in which several samples count",
            got=f"one in {got}",
            hint="a much shorter 'step'; or look at the flags (thermodata quality) and at 'phases'",
        )
