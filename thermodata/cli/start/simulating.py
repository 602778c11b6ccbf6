"""`simulate`: raw logs of a simulated machine with a known truth."""

from __future__ import annotations

from collections import Counter
from functools import partial
from pathlib import Path
from typing import Any

import click

from thermodata.cli.terminal.common import Session, command, plain
from thermodata.errors import UsageError, unknown_name
from thermodata.report.text.table import fields, table

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
        _lathe(session, stratum, first_seed, seeds, sealed, jobs, not no_rivals, out, reliability)
    else:
        _gantry(session, hide, seeds, first_seed or 0, not not_logged)


def _lathe(
    session: Session,
    stratum: tuple[str, ...],
    first_seed: int | None,
    seeds: int,
    sealed: bool,
    jobs: int,
    rivals: bool,
    out: Path | None,
    picture: Path | None,
) -> None:
    from thermodata.cli.terminal.progress import counting_line
    from thermodata.report.page.write import write_page
    from thermodata.virtual.blind.diagram import diagram
    from thermodata.virtual.blind.goals import overall
    from thermodata.virtual.blind.reliability import reliability
    from thermodata.virtual.blind.run import run
    from thermodata.virtual.blind.seeds import seeds_of, set_name
    from thermodata.virtual.blind.tally import rows
    from thermodata.virtual.lathe.strata import STRATA

    for name in stratum:
        if name not in STRATA:
            raise unknown_name("stratum", name, list(STRATA))
    if picture is not None and picture.suffix.lower() != ".svg":
        raise UsageError(
            "the diagram is drawn as SVG",
            where=f"--reliability {picture}",
            expected="a name that ends in .svg",
            got=picture.suffix or "no suffix",
            hint=f"--reliability {picture.with_suffix('.svg')}",
        )
    used = seeds_of(first_seed, seeds, sealed)
    which = f"{set_name(sealed)} seeds {used.start} to {used.stop - 1}"
    click.echo(which, err=True)
    with counting_line() as tell:
        told = partial(tell, "machines")
        trials = run(stratum or tuple(STRATA), used, jobs=jobs, rivals=rivals, out=out, tell=told)
    summary, stated, goals = rows(trials), reliability(trials), overall(trials)
    if picture is not None and stated:
        write_page(picture, diagram(stated, f"{len(trials)} machines, {which}"))
    elif picture is not None:
        click.echo(f"no answer states a probability: {picture} is not written", err=True)
    session.answer(
        {
            "machine": "lathe",
            "seeds": which,
            "rules": trials[0]["rules"],
            "overall": goals,
            "reliability": [r.to_json() for r in stated],
            "summary": summary,
            "trials": trials,
        },
        lambda: _lathe_text(summary, goals, stated, which, trials[0]["rules"]),
    )


def _lathe_text(summary: list[Any], goals: list[Any], stated: list[Any], which: str, rules: str) -> str:
    from thermodata.virtual.blind import wording

    tables = [wording.with_a_cause(summary), wording.without(summary), wording.goals(goals)]
    shown = [table(rows, [(key, key) for key in rows[0]]) for rows in tables if rows]
    said = [
        (
            f"probabilities, {wording.SORTS[r.of]}",
            f"{r.statements} stated, Brier {r.brier:.3f} (base rate {r.base_brier:.3f}), "
            f"calibration error {r.calibration_error:.3f}",
        )
        for r in stated
    ] or [("probabilities", "none stated")]
    return "\n\n".join([*shown, fields([*said, ("seeds", which), ("rules", rules)])])


def _gantry(session: Session, hide: tuple[str, ...], seeds: int, first_seed: int, logged: bool) -> None:
    from thermodata.cli.terminal.progress import counting_line
    from thermodata.virtual import HIDEABLE
    from thermodata.virtual.benchmark import benchmark

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


def marks(trials: list[dict[str, Any]]) -> dict[str, int]:
    """How many machines, how many claims, and how each trial ended."""
    ends = Counter(str(trial["outcome"]) for trial in trials)
    return {"machines": len(trials), "claims": sum(trial["found"] is not None for trial in trials), **ends}


def empty_folder(folder: Path) -> None:
    """Refuse a folder that holds something: a simulation never mixes with measured files."""
    if folder.is_dir() and any(folder.iterdir()):
        raise UsageError(
            "the folder is not empty", where=str(folder), expected="an empty or new folder", hint="name another folder"
        )
