"""`benchmark-diagnosis`: verdicts on simulated machines whose truth nobody told, marked by it."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from thermodata.cli.start.simulating import MACHINES
from thermodata.cli.terminal.common import Session, command, plain
from thermodata.errors import UsageError, unknown_name
from thermodata.report.text.table import fields, table

if TYPE_CHECKING:
    from thermodata.virtual.blind.asked import Asked


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
@click.option(
    "--sealed", is_flag=True, help="Of the lathe: the seeds that judge a frozen rule, never mixed with others."
)
@click.option("--jobs", default=1, show_default=True, type=click.IntRange(1), help="Of the lathe: processes at once.")
@click.option("--no-rivals", is_flag=True, help="Of the lathe: leave out correlation, BIC, LASSO and SINDy.")
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Of the lathe: keep each trial as a JSON line, and go on where FILE ends.",
)
@click.option(
    "--reliability",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE.svg",
    help="Of the lathe: draw the share that was right against the stated probability.",
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

    Simulated machines with one effect hidden, or none; the truth is used for marking only. The lathe is judged by
    strata: weak causes, decoys, several at once, none, coarse or broken logs.
    """
    of_lathe = {"--stratum": stratum, "--sealed": sealed, "--jobs": jobs > 1, "--no-rivals": no_rivals, "--out": out}
    of_lathe["--reliability"] = reliability
    of_gantry = {"--hide": hide, "--not-logged": not_logged}
    for option, given in (of_lathe if machine == "gantry" else of_gantry).items():
        if given:
            raise UsageError(f"{option} does not go with --machine {machine}", hint="see benchmark-diagnosis --help")
    if machine == "lathe":
        from thermodata.virtual.blind.asked import Asked
        from thermodata.virtual.blind.seeds import seeds_of

        used = seeds_of(first_seed, seeds, sealed)
        _lathe(session, Asked(used, stratum, jobs, not no_rivals, out, reliability))
    else:
        _gantry(session, hide, seeds, first_seed or 0, not not_logged)


def _lathe(session: Session, asked: Asked) -> None:
    from thermodata.cli.terminal.progress import counting_line
    from thermodata.virtual.blind.wording import text

    click.echo(asked.which, err=True)
    with counting_line() as tell:
        found = asked.answered(partial(tell, "machines"))
    if not asked.drawn(found):
        click.echo(f"no answer states a probability: {asked.picture} is not written", err=True)
    session.answer(found.to_json(), lambda: text(found))


def _gantry(session: Session, hide: tuple[str, ...], seeds: int, first_seed: int, logged: bool) -> None:
    from thermodata.cli.terminal.progress import counting_line
    from thermodata.virtual import HIDEABLE
    from thermodata.virtual.benchmark import benchmark, marks

    choices = [*HIDEABLE, "none"]
    for name in hide:
        if name not in choices:
            raise unknown_name("effect to hide", name, choices)
    trials: list[dict[str, Any]] = []
    total = len(hide or choices) * seeds
    with counting_line() as tell:
        for trial in benchmark(hide or choices, range(first_seed, first_seed + seeds), logged=logged):
            trials.append(plain(trial.to_json()))
            tell("machines", len(trials), total)
    summary = marks(trials)
    session.answer(
        {"summary": summary, "trials": trials},
        lambda: (
            table(
                trials,
                [
                    ("hidden", "hidden"),
                    ("seed", "seed"),
                    ("found", "found"),
                    ("outcome", "outcome"),
                    ("rmse_um_before", "before [um]"),
                    ("rmse_um_after", "after [um]"),
                    ("locked_rmse_um_before", "locked before [um]"),
                    ("locked_rmse_um_after", "locked after [um]"),
                    ("seconds", "s"),
                ],
            )
            + "\n\n"
            + fields(summary.items())
        ),
    )
