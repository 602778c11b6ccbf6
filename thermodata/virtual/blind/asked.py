"""A run of the blind benchmark as somebody asks for it: which machines, and where its trials and its picture go."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from thermodata.errors import UsageError, unknown_name
from thermodata.report.page.write import write_page
from thermodata.virtual.blind.counted import Counted, counted
from thermodata.virtual.blind.diagram import diagram
from thermodata.virtual.blind.machines import MACHINES
from thermodata.virtual.blind.run import Told, run
from thermodata.virtual.blind.seeds import set_name
from thermodata.virtual.truth.strata import SEALED


@dataclass(frozen=True, slots=True)
class BenchmarkRequest:
    """machine: one of `MACHINES`. used: seeds of one set, as `seeds_of` gives them. strata: of the machine, every one
    where none is named. jobs, rivals, out: as in `run`. picture: where the reliability is drawn.

    UsageError for a name that is no stratum of the machine, and a picture that is no SVG.
    """

    machine: str
    used: range
    strata: tuple[str, ...] = ()
    jobs: int = 1
    rivals: bool = True
    out: Path | None = None
    picture: Path | None = None

    def __post_init__(self) -> None:
        for name in self.strata:
            if name not in MACHINES[self.machine]:
                raise unknown_name("stratum", name, list(MACHINES[self.machine]))
        if self.picture is not None and self.picture.suffix.lower() != ".svg":
            raise UsageError(
                "the diagram is drawn as SVG",
                where=f"--reliability {self.picture}",
                expected="a name that ends in .svg",
                got=self.picture.suffix or "no suffix",
                hint=f"--reliability {self.picture.with_suffix('.svg')}",
            )

    @property
    def which(self) -> str:
        """'development seeds 42000 to 42002'."""
        return f"{set_name(self.used.start in SEALED)} seeds {self.used.start} to {self.used.stop - 1}"

    def answered(self, tell: Told | None = None) -> Counted:
        """Every trial made, or taken from `out`, and counted. tell, errors: as in `run`."""
        strata = self.strata or tuple(MACHINES[self.machine])
        trials = run(strata, self.used, jobs=self.jobs, rivals=self.rivals, out=self.out, tell=tell)
        return counted(trials, self.machine, self.which)

    def drawn(self, found: Counted) -> bool:
        """Writes the picture, where one is asked for; False where no answer states a probability that it could show."""
        if self.picture is None:
            return True
        if found.stated:
            write_page(self.picture, diagram(found.stated, f"{len(found.trials)} machines, {self.which}"))
        return bool(found.stated)
