"""The blind benchmark of the diagnosis: virtual machines with one effect hidden, or none, or one not logged."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, replace
from time import perf_counter
from typing import Any, Literal

from thermodata.diagnosis.answer import answer
from thermodata.effect import effects
from thermodata.modelling.fit import fit_model
from thermodata.schema.result import Diagnosis
from thermodata.view.dataset import Dataset
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
            data, spec = dataset(hide, seed, step_s=step_s)
            family = library[hide].family if hide in library else hide
            if not logged and hide != NONE:
                data = _without(
                    data, hide, {name for e in spec.effects for name in e.drivers.values() if isinstance(name, str)}
                )
            start = perf_counter()
            found = answer(fit_model(spec, data, uncertainty=False), data, library, "benchmark").diagnosis
            yield _trial(hide, seed, logged, family, found, perf_counter() - start)


def _trial(hide: str, seed: int, logged: bool, family: str, found: Diagnosis, seconds: float) -> Trial:
    claimed = next((c for c in found.candidates if c.claimed), None)
    outcome: Outcome
    if claimed is None:
        outcome = "right" if hide == NONE or not logged else "abstained"
    elif hide == NONE or not logged:
        outcome = "false claim"
    elif claimed.effect == hide:
        outcome = "right"
    elif hide in {name.split(":")[0] for name in claimed.equivalent}:
        outcome = "equivalent"
    else:
        outcome = "family" if claimed.family.split("_")[0] == family.split("_")[0] else "wrong"
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


def _without(data: Dataset, hide: str, kept: set[str]) -> Dataset:
    """The same data as if nobody had logged what drives the hidden effect, nor anything on the same part."""
    places = {c.split(".")[0] for c in _places(hide)}
    gone = {
        n
        for n, c in data.channels.items()
        if c.quantity != "displacement" and n not in kept and (c.at or "").split(".")[0] in places
    }

    def strip(channels: Any) -> Any:
        return {n: v for n, v in channels.items() if n not in gone}

    tests = tuple(
        replace(t, values=strip(t.values), valid=strip(t.valid), channels=strip(t.channels)) for t in data.tests
    )
    return replace(data, tests=tests, channels=strip(data.channels))


def _places(hide: str) -> list[str]:
    return [place for need in effects()[hide].needs for place in need.places]
