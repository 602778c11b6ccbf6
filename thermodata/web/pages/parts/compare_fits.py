"""What the fits of the compared models say of themselves: their parameters, and the checks that do not hold."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.report.text.fit import check_text
from thermodata.schema.answers.result import FitResult
from thermodata.view.lists.models import ModelRow


def failed_of(models: Sequence[ModelRow], results: Sequence[FitResult]) -> list[tuple[str, list[str]]]:
    """(label, what its fit says of itself, as a terminal has it) of each model with a check that does not hold."""
    told = [(m.label, [check_text(c) for c in r.checks if not c.passed]) for m, r in zip(models, results, strict=True)]
    return [(label, checks) for label, checks in told if checks]


def parameters_of(results: Sequence[FitResult]) -> list[tuple[str, list[FitResult | None]]]:
    """(name, those of the results that have it)."""
    names = dict.fromkeys(name for result in results for name in result.readable)
    return [(name, [result if name in result.parameters else None for result in results]) for name in names]
