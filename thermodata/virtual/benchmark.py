"""The blind benchmark of the diagnosis: virtual machines with one effect hidden, or none, or one not logged."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from time import perf_counter
from typing import Any, Literal

from thermodata.diagnosis.answer import answer
from thermodata.effect import effects
from thermodata.modelling.fit.model import fit_model
from thermodata.plugin import Effect
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.virtual.binned import to_dataset
from thermodata.virtual.world import make_world

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


def benchmark(hides: Iterable[str], seeds: Iterable[int], *, logged: bool) -> Iterator[Trial]:
    """Diagnose every combination; the worlds' truth is used for marking only."""
    library = effects()
    for seed in seeds:
        for hide in hides:
            world = make_world(hide, seed, measured=logged)
            data, spec = to_dataset(world, 60.0), world.baseline()
            family = true_family(hide, world.axis, library)
            start = perf_counter()
            found = answer(fit_model(spec, data, uncertainty=False), data, library, "benchmark").diagnosis
            yield _trial(hide, seed, logged, family, found, perf_counter() - start)


def true_family(hide: str, axis: str, library: Mapping[str, Effect]) -> str:
    """The family of the hidden effect, with the axis that it acts on."""
    return library[hide].family.replace("{a}", axis.lower()).replace("{s}", "") if hide in library else hide


def mark(hide: str, family: str, effect: str, claimed_family: str, equivalent: Sequence[str]) -> Outcome:
    """A claim against the truth: the effect on the right part, a twin of it, its family, or none of these."""
    if effect == hide and claimed_family == family:
        return "right"
    if hide in {name.split(":")[0] for name in equivalent}:
        return "equivalent"
    return "family" if claimed_family == family else "wrong"


def marks(trials: Sequence[Mapping[str, Any]]) -> dict[str, int]:
    """How many machines, how many claims, and how each trial ended."""
    ends = Counter(str(trial["outcome"]) for trial in trials)
    return {"machines": len(trials), "claims": sum(trial["found"] is not None for trial in trials), **ends}


def _trial(hide: str, seed: int, logged: bool, family: str, found: Diagnosis, seconds: float) -> Trial:
    claimed = next((c for c in found.candidates if c.claimed), None)
    outcome: Outcome
    if claimed is None:
        outcome = "right" if hide == NONE or not logged else "abstained"
    elif hide == NONE:
        outcome = "false claim"
    else:
        outcome = mark(hide, family, claimed.effect, claimed.family, claimed.equivalent)
        if outcome == "wrong" and not logged:
            outcome = "false claim"
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
