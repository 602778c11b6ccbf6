"""`simulate`: raw logs of a simulated machine with a known truth."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from thermodata.cli.terminal.common import Session, command, plain
from thermodata.errors import UsageError
from thermodata.report.text.table import fields

MACHINES = ("gantry", "lathe")


@command("simulate")
@click.argument("folder", type=click.Path(path_type=Path, file_okay=False), metavar="DIR")
@click.option(
    "--machine",
    type=click.Choice(MACHINES),
    default="gantry",
    show_default=True,
    help="A gantry milling centre (TDMS, CNC, MCAP), or a turning centre that shares nothing with it (CSV).",
)
@click.option(
    "--hide",
    default=None,
    metavar="EFFECT",
    help="The effect of the gantry, or the cause of the lathe, that the baseline model lacks; or none.",
)
@click.option("--stratum", default=None, metavar="NAME", help="Of the lathe: the difficulty.  [default: strong]")
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0), help="Another seed, another machine.")
def simulate_command(
    session: Session, folder: Path, machine: str, hide: str | None, stratum: str | None, seed: int
) -> None:
    """Write a simulated campaign with a known truth into DIR.

    Raw logs, campaign file, model file, and the truth.
    """
    from thermodata.cli.terminal.progress import counting_line
    from thermodata.store.base.counting import watched

    if machine == "gantry" and stratum:
        raise UsageError("--stratum does not go with --machine gantry", hint="add --machine lathe")
    empty_folder(folder)
    with counting_line() as tell, watched(tell):
        truth = _simulate_lathe(folder, hide, stratum, seed) if machine == "lathe" else _simulate(folder, hide, seed)
    session.answer(truth, lambda: fields((k, v) for k, v in truth.items() if not isinstance(v, dict | list)))


def _simulate(folder: Path, hide: str | None, seed: int) -> Any:
    from thermodata.virtual import simulate

    return plain(simulate(folder, hide=hide or "none", seed=seed))


def _simulate_lathe(folder: Path, hide: str | None, stratum: str | None, seed: int) -> Any:
    from thermodata.virtual.lathe.logs import simulate_lathe

    if hide == "none" and stratum is None:
        return plain(simulate_lathe(folder, "none_full", seed))
    return plain(simulate_lathe(folder, stratum or "strong", seed, hide=hide))


def empty_folder(folder: Path) -> None:
    """Refuse a folder that holds something: a simulation never mixes with measured files."""
    if folder.is_dir() and any(folder.iterdir()):
        raise UsageError(
            "the folder is not empty", where=str(folder), expected="an empty or new folder", hint="name another folder"
        )
