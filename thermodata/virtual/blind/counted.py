"""What a run of the blind benchmark comes to: its trials, and all that is counted of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from thermodata.virtual.blind.goals import overall
from thermodata.virtual.blind.reliability import Reliability, reliability
from thermodata.virtual.blind.tally import Row, rows


@dataclass(frozen=True, slots=True)
class Counted:
    """machine: which all trials are of. seeds: which, in words. rules: the fingerprint of the code that all trials are
    of. summary: a row a stratum; goals: a row a question, as in `overall`."""

    machine: str
    seeds: str
    rules: str
    trials: Sequence[Row]
    summary: Sequence[Row]
    goals: Sequence[Row]
    stated: Sequence[Reliability]

    def to_json(self) -> dict[str, Any]:
        return {
            "machine": self.machine,
            "seeds": self.seeds,
            "rules": self.rules,
            "overall": self.goals,
            "reliability": [one.to_json() for one in self.stated],
            "summary": self.summary,
            "trials": self.trials,
        }


def counted(trials: Sequence[Row], machine: str, seeds: str) -> Counted:
    """trials: as `run` gives them, at least one, all of one machine. seeds: which, in words."""
    return Counted(machine, seeds, trials[0]["rules"], trials, rows(trials), overall(trials), reliability(trials))
