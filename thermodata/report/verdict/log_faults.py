"""Faults of the logs as a person reads them: the same fault of several tests is told once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Artefact


@dataclass(frozen=True, slots=True)
class LogFault:
    """tests: (campaign, test) of each that has it, None for all tests of the campaign; at_s, size_um: where it is one
    moment of one test."""

    kind: str
    tests: tuple[tuple[str, str | None], ...]
    at_s: float | None
    size_um: float | None
    why: str

    @property
    def step_um(self) -> float | None:
        """The size of what happened at one moment; None where it is an error of the whole test, which is no size of the
        fault (a probe that is turned round is as wrong as the response is large)."""
        return None if self.at_s is None else self.size_um

    @property
    def where(self) -> list[str]:
        """The tests that have it, by their names alone."""
        return ["all tests" if test is None else test for _, test in self.tests]

    @property
    def places(self) -> list[str]:
        """The same with their campaigns."""
        return [f"all tests of {c}" if test is None else f"{c}/{test}" for c, test in self.tests]


def log_faults(artefacts: Sequence[Artefact]) -> list[LogFault]:
    """In their order; those of the same kind, for the same reason and of no moment stand together."""
    found: dict[object, LogFault] = {}
    for a in artefacts:
        of_moment = a.at_s is not None or a.size_um is not None
        key = (a.kind, a.why, (a.campaign, a.test, a.at_s) if of_moment else None)
        tests = (*(found[key].tests if key in found else ()), (a.campaign, a.test))
        found[key] = LogFault(a.kind, tests, a.at_s, a.size_um, a.why)
    return list(found.values())
