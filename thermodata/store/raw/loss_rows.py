"""Losses of a raw file as text, as the table `file` keeps them."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from typing import Any

from thermodata.plugin import Loss


def losses_to_json(losses: Sequence[Loss]) -> str:
    """A list of objects. What concerns no signal is written as older stores have it."""
    rows = [dataclasses.asdict(loss) for loss in losses]
    return json.dumps([{k: v for k, v in row.items() if k != "signal" or v is not None} for row in rows], default=plain)


def losses_from_json(text: str | None) -> tuple[Loss, ...]:
    """The same losses again; none of an empty text."""
    return () if text in (None, "", "[]") else tuple(Loss(**loss) for loss in json.loads(text))


def plain(value: Any) -> Any:
    """What JSON knows of a number of numpy; a text of all else."""
    return value.item() if hasattr(value, "item") else str(value)
