"""`predict`: a model on logs without displacement."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, command
from thermodata.cli.terminal.pairs import name_and_value
from thermodata.cli.terminal.stored_model import resolve
from thermodata.report.text.band import band_text, elsewhere_text, locked_lines
from thermodata.report.text.table import table
from thermodata.report.words.glossary import PREDICTED_LEVEL
from thermodata.report.words.numbers import duration, number

if TYPE_CHECKING:
    from thermodata.draft.known.to_predict import LogsPredicted
    from thermodata.modelling.predictions.beyond import Beyond
    from thermodata.modelling.predictions.predict import Predicted
    from thermodata.store import Store


@command("predict")
@click.argument("model", shell_complete=completing.models)
@click.argument("target", metavar="FOLDER|LOG|CAMPAIGN")
@click.option("--test", "tests", multiple=True, metavar="TEST", help="Only this test; may be repeated.")
@click.option(
    "--set",
    "conditions",
    multiple=True,
    metavar="NAME=VALUE",
    help="A condition of the tests, for gain_by: spindle=SP2.",
)
@click.option(
    "--out",
    "-o",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Write the course as .parquet or .csv.",
)
@click.option("--csv", "as_csv", is_flag=True, help="Print the course as CSV.")
@click.option("--force", is_flag=True, help="Replace FILE where it exists.")
def predict_command(
    session: Session,
    model: str,
    target: str,
    tests: tuple[str, ...],
    conditions: tuple[str, ...],
    out: Path | None,
    as_csv: bool,
    force: bool,
) -> int:
    """Predict logs without displacement with MODEL.

    A folder of raw logs like those of the model's campaign (or with a campaign file of its own), one of these logs
    (the others of its test are read beside it), a campaign file, or a campaign of the store (campaign:ID where a
    path is called so too). In each test temperatures count from their first values, and what is zero at rest
    (speeds, powers, switches) counts as at rest before the first sample. t_s is where a step of the model begins, and
    the value its mean over that step: it belongs to the step's middle.

    Of a folder only the logs are read that the model reads. A campaign of the store has all of its logs, of which
    another may begin minutes before: the steps of a test begin there, and the course lies a little (0.1 um) beside
    that of the folder.

    The band of 95 % is of the parameters, the calibration of the probe that was fitted, and what the model leaves on
    tests that took no part in its fit; the text says what it does not hold.
    Exit code 3 says that tests were left out.
    """
    from thermodata.cli.terminal.progress import progress_line
    from thermodata.draft.known.to_predict import Listener, ToPredict, predict_logs
    from thermodata.export.series import check_out, write_table

    kind = None if out is None else check_out(out, force)
    store = session.store()
    one, given = resolve(store, model), dict(map(_condition, conditions))
    with progress_line() as line:
        logs = predict_logs(store, one, ToPredict(target, tests, given), Listener(session.say, line))
    for reason in logs.left_out:
        session.say(f"left out: {reason}")
    if logs.made and out is not None and kind is not None:
        write_table(logs.made, out, kind)
    if as_csv and not session.as_json:
        _print_csv(logs.made)
    else:
        _answer(session, store, logs, out)
    return 3 if logs.left_out else 0


def _answer(session: Session, store: Store, logs: LogsPredicted, out: Path | None) -> None:
    from thermodata.modelling.predictions.beyond import beyond
    from thermodata.modelling.predictions.carried_on import said
    from thermodata.store.catalogue.models.stale import stale_line

    loaded, band, made = logs.loaded, logs.band, logs.made
    rows = [_row(p) for p in made]
    further = beyond(loaded.fitted, loaded.data, made)
    held = list(dict.fromkeys(one for p in made for one in p.held))
    elsewhere = elsewhere_text(loaded.identity, band, made)
    locked = locked_lines(loaded.identity, made)
    payload = {
        "model": loaded.identity,
        "name": loaded.fitted.spec.name,
        "step_s": loaded.data.step_s,
        "file": None if out is None or not made else str(out),
        "tests": [{**row, **_course(p)} for row, p in zip(rows, made, strict=True)],
        "left_out": logs.left_out,
        "beyond": further,
        "held": held,
        "band": band,
        "elsewhere": elsewhere,
        "locked": locked,
        "stale": stale_line(store, loaded.identity),
    }
    more = [*locked, *elsewhere, *said(held), *band_text(band, made)]
    session.answer(payload, lambda: _text(rows, made, further, more, out))


def _print_csv(made: list[Predicted]) -> None:
    """The course of every test; nothing where there is none."""
    import pyarrow.csv

    from thermodata.export.series import as_table

    if made:
        pyarrow.csv.write_csv(as_table(made, unit_in_names=True), sys.stdout.buffer)


def _course(p: Predicted) -> dict[str, Any]:
    """The predicted course as arrays of shape (n,), in the unit of the response; t_s: where each step begins [s]."""
    return {"t_s": p.t_s, "predicted": p.predicted, "predicted_low": p.ends[0], "predicted_high": p.ends[1]}


def _row(p: Predicted) -> dict[str, Any]:
    """A line of the answer: low, high, end, rmse and half_95 (the widest half band) in the unit of the response; known:
    the share of steps whose drivers are."""
    known = p.predicted[p.known]
    return {
        "campaign": p.campaign,
        "test": p.test,
        "response": p.response,
        "unit": p.unit,
        "machine": p.machine or None,
        "hours": float(p.t_s[-1] - p.t_s[0]) / 3600.0 if len(p.t_s) else 0.0,
        "low": float(known.min()) if len(known) else None,
        "high": float(known.max()) if len(known) else None,
        "end": float(known[-1]) if len(known) else None,
        "known": float(p.known.mean()) if len(p.known) else 0.0,
        "rmse": p.rmse,
        "half_95": float(p.half[p.known].max()) if p.half is not None and p.known.any() else None,
    }


def _text(
    rows: list[dict[str, Any]], made: list[Predicted], further: list[Beyond], more: list[str], out: Path | None
) -> str:
    if not made:
        return "no test can be predicted"
    several = {key for key in ("response", "unit") if len({r[key] for r in rows}) > 1}
    unit = "" if "unit" in several else f" [{made[0].unit}]"
    shown = [
        {**r, "length": duration(r["hours"] * 3600), "known": f"{100 * r['known']:.0f} %", "rmse": r["rmse"]}
        for r in rows
    ]
    columns = [("campaign", "campaign"), ("test", "test")]
    columns += [(key, key) for key in ("response", "unit") if key in several]
    columns += [
        ("length", "length"),
        ("low", f"lowest{unit}"),
        ("high", f"highest{unit}"),
        ("end", f"at the end{unit}"),
        ("known", "drivers known"),
    ]
    columns += [("half_95", f"95 %, at most ±{unit}")] if any(r["half_95"] is not None for r in rows) else []
    scored = any(r["rmse"] is not None for r in rows)
    columns += [("rmse", f"RMSE, where measured{unit}")] if scored else []
    text = table(shown, columns) + (f"\n\n{PREDICTED_LEVEL}" if scored else "")
    if further:
        head = "beyond the tests that the model is fitted to, where nothing says that an effect goes on in proportion"
        text += "\n".join(["", "", head, *(f"  {_beyond_in_words(one)}" for one in further)])
    text += "".join(f"\n\n{line}" for line in more)
    return text if out is None else f"{text}\n\n{out}"


def _beyond_in_words(one: Beyond) -> str:
    """'T11: coolant_heat (T_tank * on) goes to -61.3 um, in these tests to -44.0 um at most'."""
    drivers = f" ({', '.join(one.drivers)})" if one.drivers else ""
    most = f"to {number(one.fitted)} {one.unit} at most" if one.fitted else "nowhere to that side"
    return f"{one.test}: {one.effect}{drivers} goes to {number(one.reaches)} {one.unit}, in these tests {most}"


def _condition(text: str) -> tuple[str, str | float]:
    """'spindle=SP2' or 'coolant_l_min=12', whose value is a number."""
    name, value = name_and_value(text, "a condition", "NAME=VALUE, for example spindle=SP2")
    try:
        return name, float(value)
    except ValueError:
        return name, value
