"""`benchmark-diagnosis`: verdicts on simulated machines whose truth nobody told, marked by it."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from thermodata.cli.start.simulating import MACHINES
from thermodata.cli.terminal.common import Session, command
from thermodata.errors import UsageError

if TYPE_CHECKING:
    from thermodata.virtual.blind.asked import BenchmarkRequest


@command("benchmark-diagnosis")
@click.option(
    "--machine",
    type=click.Choice(MACHINES),
    default="gantry",
    show_default=True,
    help="The gantry hides effects of the library; the lathe knows nothing of them, and has strata.",
)
@click.option("--hide", multiple=True, metavar="EFFECT", help="Hide this effect, or none (default: each in turn).")
@click.option("--seeds", default=1, show_default=True, type=click.IntRange(1), help="Machines for each.")
@click.option("--first-seed", default=None, type=click.IntRange(0), help="The first seed (default: the set's first).")
@click.option("--not-logged", is_flag=True, help="Leave the channels of the hidden effect out of the log.")
@click.option("--stratum", multiple=True, metavar="NAME", help="Of the lathe: this stratum (default: each in turn).")
@click.option("--sealed", is_flag=True, help="The seeds that judge a frozen rule, never mixed with others.")
@click.option("--jobs", default=1, show_default=True, type=click.IntRange(1), help="Processes at once.")
@click.option("--no-rivals", is_flag=True, help="Leave out correlation, BIC, LASSO and SINDy.")
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Keep each trial as a JSON line, and go on where FILE ends.",
)
@click.option(
    "--reliability",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE.svg",
    help="Draw the share that was right against the stated probability.",
)
def benchmark_diagnosis_command(
    session: Session,
    machine: str,
    hide: tuple[str, ...],
    seeds: int,
    first_seed: int | None,
    not_logged: bool,
    stratum: tuple[str, ...],
    sealed: bool,
    jobs: int,
    no_rivals: bool,
    out: Path | None,
    reliability: Path | None,
) -> None:
    """Run the blind benchmark of the diagnosis.

    Simulated machines as they are drawn; the truth is used for marking only. The gantry lacks an effect and others
    beside it, or none; the lathe is judged by strata: weak causes, decoys, several at once, coarse or broken logs.
    """
    of_other = {"--stratum": stratum} if machine == "gantry" else {"--hide": hide, "--not-logged": not_logged}
    for option, given in of_other.items():
        if given:
            raise UsageError(f"{option} does not go with --machine {machine}", hint="see benchmark-diagnosis --help")
    from thermodata.virtual.blind.asked import BenchmarkRequest
    from thermodata.virtual.blind.seeds import seeds_of
    from thermodata.virtual.gantry.case import strata_of

    strata = strata_of(hide, logged=not not_logged) if machine == "gantry" else stratum
    used = seeds_of(first_seed, seeds, sealed)
    _answer(session, BenchmarkRequest(machine, used, strata, jobs, not no_rivals, out, reliability))


def _answer(session: Session, asked: BenchmarkRequest) -> None:
    from thermodata.cli.terminal.progress import counting_line
    from thermodata.virtual.blind.wording import text

    click.echo(asked.which, err=True)
    with counting_line() as tell:
        found = asked.answered(partial(tell, "machines"))
    if not asked.drawn(found):
        click.echo(f"no answer states a probability: {asked.picture} is not written", err=True)
    session.answer(found.to_json(), lambda: text(found))
