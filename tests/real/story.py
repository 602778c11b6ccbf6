"""The story on measured data: ingest, fit, then diagnose and add until nothing more is claimed.

Used by test_real.py and figures.py. Errors are in the response's unit (um, or K for a temperature).
"""

from __future__ import annotations

import io
import json
import shutil
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thermodata.cli import main

HERE = Path(__file__).parent
DATA = Path(__file__).parents[2] / ".." / "shared" / "data"


@dataclass(frozen=True)
class Recording:
    """A campaign of this folder and the measured file that belongs beside it."""

    folder: str
    file: Path
    models: tuple[str, ...]


RECORDINGS = (
    Recording("fl_thermal", DATA / "fl_thermal" / "data.xlsx", ("ch1", "ch3", "ch5")),
    Recording("heater", DATA / "tdms" / "test_4_DUT_18.tdms", ("leafspring",)),
)


@dataclass(frozen=True)
class Round:
    """One round of diagnose and add. model: the id before; better: the answer of `add`, None if none was claimed."""

    model: str
    diagnosis: dict[str, Any]
    claimed: dict[str, Any] | None
    better: dict[str, Any] | None


def row(recording: str, number: int, one: Round) -> str:
    """A round as a line of a table: recording, response, round, verdict, claimed, left-out, locked, not told from."""
    found, best = one.diagnosis, one.claimed
    cells = [recording, found["response"], str(number), found["verdict"]]
    if best is None:
        cells += ["-", "" if found["rmse_um"] is None else f"{found['rmse_um']:.2f}", "", ""]
    else:
        cells += [
            best["id"],
            f"{best['rmse_um_before']:.2f} -> {best['rmse_um_after']:.2f}",
            f"{best['locked_rmse_um_before']:.2f} -> {best['locked_rmse_um_after']:.2f}",
            ", ".join(best["equivalent"]),
        ]
    return "| " + " | ".join(cells) + " |"


class Bench:
    """A recording in a store of its own."""

    def __init__(self, recording: Recording, folder: Path, edit: Callable[[Path], None] | None = None) -> None:
        """edit: what to do to the campaign file before it is ingested."""
        self.folder = folder / recording.folder
        shutil.copytree(HERE / recording.folder, self.folder)
        if edit:
            edit(self.folder / "campaign.yaml")
        shutil.copy(recording.file, self.folder)
        self.ingested = self.ask("ingest", self.folder / "campaign.yaml")

    def ask(self, *words: object) -> Any:
        """The JSON of a command, run in this process; it must succeed."""
        out, err = io.StringIO(), io.StringIO()
        with redirect_stdout(out), redirect_stderr(err):
            code = main(["--store", str(self.folder / "store"), *map(str, words), "--json"])
        if code:
            raise RuntimeError(f"{words}: exit code {code}\n{err.getvalue()}")
        return json.loads(out.getvalue())

    def rounds(self, model: str, most: int = 4) -> Iterator[Round]:
        """Diagnose and add, from the fitted baseline of a model file, until nothing is claimed."""
        at = str(self.ask("fit", self.folder / f"{model}.yaml")["model"])
        for _ in range(most):
            found = self.ask("diagnose", at)
            claimed = next((c for c in found["candidates"] if c["claimed"]), None)
            better = self.ask("add", at, claimed["rank"]) if claimed else None
            yield Round(at, found, claimed, better)
            if better is None:
                return
            at = str(better["model"])
