"""`simulate`: raw logs of a simulated machine with a known truth."""

from __future__ import annotations

from pathlib import Path

import click

from thermodata.cli.common import Session, command, plain
from thermodata.cli.table import fields
from thermodata.errors import UsageError


@command("simulate")
@click.argument("folder", type=click.Path(path_type=Path, file_okay=False), metavar="DIR")
@click.option("--hide", default="none", show_default=True, metavar="EFFECT",
              help="The effect that the machine has and the baseline model lacks; or none.")
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0), help="Another seed, another machine.")
def simulate_command(session: Session, folder: Path, hide: str, seed: int) -> None:
    """Write a simulated campaign with a known truth into DIR.

    TDMS, CNC and MCAP logs, campaign file, model file, and the truth.
    """
    from thermodata.virtual import simulate

    empty_folder(folder)
    truth = plain(simulate(folder, hide=hide, seed=seed))
    session.answer(truth, lambda: fields((k, v) for k, v in truth.items() if not isinstance(v, dict | list)))


@command("benchmark-diagnosis")
def benchmark_diagnosis_command(session: Session) -> None:
    """Run the blind benchmark of the diagnosis."""
    raise UsageError("'benchmark-diagnosis' is not supported yet",
                     hint="thermodata demo --seed N runs one blind case from raw files to the verdict")


def empty_folder(folder: Path) -> None:
    """Refuse a folder that holds something: a simulation never mixes with measured files."""
    if folder.is_dir() and any(folder.iterdir()):
        raise UsageError("the folder is not empty", where=str(folder), expected="an empty or new folder",
                         hint="name another folder")
