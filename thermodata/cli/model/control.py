"""A model taken out of the lab: shown as a system, run on logs without displacement, written for a control."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, WithActions, command
from thermodata.cli.terminal.pairs import name_and_value
from thermodata.cli.terminal.stored_model import resolve
from thermodata.errors import UsageError
from thermodata.report.text.table import fields

if TYPE_CHECKING:
    from thermodata.export.control.program import Program
    from thermodata.export.control.write import Written
    from thermodata.modelling.run import Loaded
    from thermodata.store import Store

_TARGETS = ("st", "scl", "c", "python", "json", "mat", "yaml")


def _seconds(ctx: click.Context, param: click.Parameter, value: str) -> float:
    """A time as '1s', '500 ms', '10 min'; a bare number is in seconds."""
    from thermodata.schema.units.value import value_in

    return value_in(value, "s")


@command("model", cls=WithActions, actions={"export": None})
@click.argument("action", type=click.Choice(["export"]))
@click.argument("model", shell_complete=completing.models)
@click.option(
    "--to",
    "target",
    type=click.Choice(_TARGETS),
    required=True,
    help="Structured text, Siemens SCL, C99, and so on; yaml: its model file.",
)
@click.option(
    "--cycle",
    metavar="TIME",
    callback=_seconds,
    default="1s",
    show_default=True,
    help="The control calls it this often: 1s, 100 ms.",
)
@click.option(
    "--out", "-o", type=click.Path(path_type=Path, file_okay=False), metavar="DIR", help="Where to write (default: .)."
)
@click.option("--real", type=click.Choice(["real", "lreal"]), help="Width of numbers: 32 or 64 bits (st, scl: real).")
@click.option("--response", metavar="CHANNEL", help="Which, of a model with several.")
@click.option("--name", metavar="NAME", help="Of the program (default: model_response), or of the model file.")
@click.option("--without", metavar="EFFECT,...", default="", help="Effects to leave out.")
@click.option("--group", "groups", multiple=True, metavar="EFFECT=VALUE", help="Whose gain, where gain_by has several.")
@click.option(
    "--limit", type=float, metavar="UM", help="Largest correction [um] (default: half more than in the tests)."
)
@click.option(
    "--rate", type=float, metavar="UM", help="Largest change [um a minute] (default: twice what the tests had)."
)
@click.option(
    "--hold",
    metavar="TIME",
    callback=_seconds,
    default="10 min",
    show_default=True,
    help="How long a bad reading is held.",
)
@click.option("--force", is_flag=True, help="Replace files that exist.")
def model_command(
    session: Session,
    action: str,
    model: str,
    target: str,
    cycle: float,
    out: Path | None,
    real: str | None,
    response: str | None,
    name: str | None,
    without: str,
    groups: tuple[str, ...],
    limit: float | None,
    rate: float | None,
    hold: float,
    force: bool,
) -> None:
    """Write MODEL as a program for a control: model export MODEL --to st.

    Frozen and self-contained, for a fixed cycle: it starts (temperatures count from their mean of the next minutes,
    while they stand still; speeds, powers and switches as at rest before) or goes on from its last state, holds bad
    readings, and limits the correction and its rate. What can't run there is refused with the reason.

    With --to yaml it is the model file of a version that 'add' made: edit it, and 'fit' it.
    """
    from thermodata.export.control import write
    from thermodata.export.control.of_model import ProgramRequest, program_of
    from thermodata.export.control.write import files_of
    from thermodata.modelling.inputs import moved
    from thermodata.modelling.run import load
    from thermodata.store.catalogue.models.stale import stale_line

    store = session.store()
    if target == "yaml":
        _model_file(session, store, resolve(store, model), (out or Path(), name), force)
        return
    loaded = load(store, resolve(store, model))
    stale = stale_line(store, loaded.identity)
    left_out = tuple(n.strip() for n in without.split(",") if n.strip())
    gains_of = dict(name_and_value(text, "a group", "EFFECT=VALUE, for example spindle_bearing=SP2") for text in groups)
    asked = ProgramRequest(cycle, response, name, left_out, gains_of, limit, rate, hold, loaded.fitted_to, stale)
    program = program_of(loaded.identity, loaded.fitted, loaded.data, asked)
    folder = out or Path()
    _refuse_to_replace([folder / n for n in files_of(program, target)], force)
    written = write(program, target, folder, real)
    for note in moved.said(loaded.data, _read_by(loaded)):
        session.say(note)
    payload = {
        "model": loaded.identity,
        "response": program.response,
        "to": target,
        "files": list(written.files),
        "cycle_s": program.cycle_s,
        "real": written.real,
        "inputs": [{"name": i.name, "unit": i.unit, "low": i.low, "high": i.high} for i in program.inputs],
        "effects": [t.effect for t in program.terms],
        "states": len(program.states),
        "limit": program.limits.correction,
        "rate_per_min": program.limits.rate,
        "hold_s": program.limits.hold_s,
        "left_out": list(left_out),
        "stale": stale,
    }
    session.answer(payload, lambda: _program_text(loaded, program, written))


def _read_by(loaded: Loaded) -> set[str]:
    """The channels that the model reads."""
    terms = [term.bound for response in loaded.fitted.responses for term in response.terms]
    return {name for term in terms for test in loaded.data.tests if term.covers(test) for name in term.reads(test)}


def _program_text(loaded: Loaded, program: Program, written: Written) -> str:
    limits = program.limits
    return fields(
        [
            ("model", f"{loaded.fitted.spec.name} {loaded.identity}"),
            ("files", list(written.files)),
            ("cycle", f"{program.cycle_s:g} s"),
            ("numbers", f"{written.real} ({32 if written.real == 'real' else 64} bits)"),
            ("inputs", [f"{i.name} [{i.unit}]" for i in program.inputs]),
            ("states", len(program.states)),
            ("limit", f"{limits.correction:g} {program.unit}, {limits.rate:g} {program.unit}/min"),
            ("bad readings", f"held for {limits.hold_s:g} s"),
        ]
    )


def _model_file(session: Session, store: Store, model: str, to: tuple[Path, str | None], force: bool) -> None:
    """Writes a model's file, and answers. to: the folder, and another name than the model's."""
    from thermodata.export.model_file import model_path, write_model
    from thermodata.store.catalogue.models.fits import find_model
    from thermodata.store.catalogue.models.stale import stale_line

    stored = find_model(store, model)
    path = model_path(stored.spec, *to)
    _refuse_to_replace([path], force)
    written = str(write_model(stored.spec, path))
    no_program = dict.fromkeys(("response", "cycle_s", "real", "inputs", "effects", "states", "limit"))
    no_program |= dict.fromkeys(("rate_per_min", "hold_s", "left_out"))
    payload = {
        **no_program,
        "model": stored.model,
        "to": "yaml",
        "files": [written],
        "effects": [e.effect for e in stored.spec.effects],
        "stale": stale_line(store, stored.model),
    }
    session.answer(payload, lambda: fields([("model", f"{stored.name} {stored.model}"), ("files", [written])]))


def _refuse_to_replace(paths: Sequence[Path], force: bool) -> None:
    there = [str(path) for path in paths if path.exists()]
    if there and not force:
        raise UsageError(
            "the file exists",
            where=", ".join(there),
            hint="--force replaces it, --out DIR writes elsewhere, --name NAME under another name",
        )
