"""One test of a campaign, as all makes have it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime

from .bodies import Array


@dataclass(frozen=True)
class TestRun:
    """inputs: what the machine and the hall do, by name, a value each step."""

    id: str
    kind: str
    role: str
    start: datetime
    inputs: Mapping[str, Array]
