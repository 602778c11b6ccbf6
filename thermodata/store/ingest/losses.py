"""What an ingest says of a test: what was lost, and what is worth knowing."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from thermodata.plugin import Loss

Losses = list[dict[str, Any]]


@dataclass(slots=True)
class Said:
    """Of one test, or ('' as its name) of what belongs to none."""

    losses: Losses = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def loss_row(
    reason: str,
    *,
    test: str | None = None,
    source: str | None = None,
    file: str | None = None,
    loss: Loss | None = None,
) -> dict[str, Any]:
    """A loss as the summary tells it; times in seconds of the file's own clock."""
    return {
        "test": test,
        "source": source,
        "file": file,
        "where": loss.where if loss else None,
        "from_ns": loss.from_ns if loss else None,
        "to_ns": loss.to_ns if loss else None,
        "fraction": loss.fraction if loss else None,
        "reason": reason,
    }
