"""The blind benchmark of the diagnosis: virtual machines with one effect hidden, or none, or one not logged."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from time import perf_counter
from typing import Any, Literal

from thermodata.diagnosis.answer import answer
from thermodata.effect import effects
from thermodata.modelling.fit import fit_model
from thermodata.schema.result import Diagnosis
from thermodata.virtual.world import dataset

Outcome = Literal["right", "equivalent", "family", "wrong", "abstained", "false claim"]
NONE = "none"


@dataclass(frozen=True, slots=True)
class Trial:
    """One machine. logged: whether the channels of the hidden effect were left in the log."""

    hidden: str
    seed: int
    logged: bool
    verdict: str
    found: str | None
    equivalent: tuple[str, ...]
    outcome: Outcome
    rmse_um_before: float | None
    rmse_um_after: float | None
    locked_rmse_um_before: float | None
    locked_rmse_um_after: float | None
    seconds: float

    def to_json(self) -> dict[str, Any]:
        return asdict(self)


def benchmark(
    hides: Iterable[str], seeds: Iterable[int], *, logged: bool = True, step_s: float = 60.0
) -> Iterator[Trial]:
    """Diagnose every combination; the worlds' truth is used for marking only."""
    library = effects()
    for seed in seeds:
        for hide in hides:
            data, spec = dataset(hide, seed, step_s, measured=logged)
            family = library[hide].family if hide in library else hide
            start = perf_counter()
            found = answer(fit_model(spec, data, uncertainty=False), data, library, "benchmark").diagnosis
            yield _trial(hide, seed, logged, family, found, perf_counter() - start)


def _trial(hide: str, seed: int, logged: bool, family: str, found: Diagnosis, seconds: float) -> Trial:
    claimed = next((c for c in found.candidates if c.claimed), None)
    outcome: Outcome
    if claimed is None:
        outcome = "right" if hide == NONE or not logged else "abstained"
    elif hide == NONE:
        outcome = "false claim"
    elif claimed.effect == hide:
        outcome = "right"
    elif hide in {name.split(":")[0] for name in claimed.equivalent}:
        outcome = "equivalent"
    elif claimed.family.split("_")[0] == family.split("_")[0]:
        outcome = "family"
    else:
        outcome = "wrong" if logged else "false claim"
    return Trial(
        hide,
        seed,
        logged,
        found.verdict,
        claimed.id if claimed else None,
        tuple(claimed.equivalent) if claimed else (),
        outcome,
        claimed.rmse_um_before if claimed else found.rmse_um,
        claimed.rmse_um_after if claimed else None,
        claimed.locked_rmse_um_before if claimed else None,
        claimed.locked_rmse_um_after if claimed else None,
        seconds,
    )
