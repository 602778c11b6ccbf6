"""`predict`: a model on logs without displacement."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from thermodata.cli import completing
from thermodata.cli.common import Session, command
from thermodata.cli.fitting import resolve
from thermodata.errors import UsageError
from thermodata.report.table import table
from thermodata.report.words import duration

if TYPE_CHECKING:
    from thermodata.modelling.fitted import FittedModel
    from thermodata.modelling.predict import Predicted
    from thermodata.store import Store
    from thermodata.view.dataset import Dataset


@command("predict")
@click.argument("model", shell_complete=completing.models)
@click.argument("target", metavar="FOLDER|CAMPAIGN")
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

    A folder of raw logs like those of the model's campaign (or with a campaign file of its own), a campaign file, or a
    campaign of the store. The model starts in balance at the start of each test. Exit code 3 says that tests were
    left out.
    """
    from thermodata.export.series import as_table, check_out, write_table
    from thermodata.modelling.predict import predict
    from thermodata.modelling.run import load

    kind = None if out is None else check_out(out, force)
    store = session.store()
    loaded = load(store, resolve(store, model))
    with _data(session, store, loaded.fitted, target) as (data, empty):
        chosen = _chosen(data, tests, dict(_pair(c) for c in conditions))
        made, left_out = predict(loaded.fitted, chosen)
    left_out += [f"{name}: nothing in its logs is read by the model" for name in empty if not tests]
    for reason in left_out:
        session.say(f"left out: {reason}")
    if not made:
        raise UsageError("no test can be predicted", where=target, got="; ".join(left_out) or "no test")
    if out is not None and kind is not None:
        write_table(made, out, kind)
    if as_csv and not session.as_json:
        import pyarrow.csv

        pyarrow.csv.write_csv(as_table(made, unit_in_names=True), sys.stdout.buffer)
        return 3 if left_out else 0
    rows = [_row(p) for p in made]
    payload = {
        "model": loaded.identity,
        "name": loaded.fitted.spec.name,
        "step_s": loaded.data.step_s,
        "file": None if out is None else str(out),
        "tests": [{**row, "t_s": p.t_s, "predicted": p.predicted} for row, p in zip(rows, made, strict=True)],
        "left_out": left_out,
    }
    session.answer(payload, lambda: _text(rows, made, out))
    return 3 if left_out else 0


def _row(p: Predicted) -> dict[str, Any]:
    known = p.predicted[p.known]
    return {
        "campaign": p.campaign,
        "test": p.test,
        "response": p.response,
        "unit": p.unit,
        "hours": float(p.t_s[-1] - p.t_s[0]) / 3600.0 if len(p.t_s) else 0.0,
        "low": float(known.min()) if len(known) else None,
        "high": float(known.max()) if len(known) else None,
        "end": float(known[-1]) if len(known) else None,
        "known": float(p.known.mean()) if len(p.known) else 0.0,
        "rmse": p.rmse,
    }


def _text(rows: list[dict[str, Any]], made: list[Predicted], out: Path | None) -> str:
    unit = made[0].unit
    shown = [
        {**r, "length": duration(r["hours"] * 3600), "known": f"{100 * r['known']:.0f} %", "rmse": r["rmse"]}
        for r in rows
    ]
    columns = [("campaign", "campaign"), ("test", "test")]
    columns += [("response", "response")] if len({r["response"] for r in rows}) > 1 else []
    columns += [
        ("length", "length"),
        ("low", f"lowest [{unit}]"),
        ("high", f"highest [{unit}]"),
        ("end", f"at the end [{unit}]"),
        ("known", "drivers known"),
    ]
    columns += [("rmse", f"RMSE, where measured [{unit}]")] if any(r["rmse"] is not None for r in rows) else []
    text = table(shown, columns)
    return text if out is None else f"{text}\n\n{out}"


def _pair(text: str) -> tuple[str, str | float]:
    name, found, value = text.partition("=")
    if not found or not name.strip():
        raise UsageError("a condition", expected="NAME=VALUE, for example spindle=SP2", got=text)
    try:
        return name.strip().removeprefix("conditions."), float(value)
    except ValueError:
        return name.strip().removeprefix("conditions."), value.strip()


def _chosen(data: Dataset, tests: tuple[str, ...], conditions: dict[str, str | float]) -> Dataset:
    from thermodata.errors import unknown_name

    known = [t.test for t in data.tests]
    for name in tests:
        if name not in known:
            raise unknown_name("test", name, known)
    machine = conditions.pop("machine", None)
    kept = tuple(
        replace(t, conditions={**t.conditions, **conditions}, machine=t.machine if machine is None else str(machine))
        for t in data.tests
        if not tests or t.test in tests
    )
    return replace(data, tests=kept)


@contextmanager
def _data(session: Session, store: Store, fitted: FittedModel, target: str) -> Iterator[tuple[Dataset, list[str]]]:
    """The tests of a campaign of the store; of a campaign file or a folder, through a store that goes again. And tests
    without data."""

    path = Path(target)
    with store.reader() as con:
        known = [str(row[0]) for row in con.execute("select campaign from campaign order by 1").fetchall()]
    if path.exists() and target in known:
        raise UsageError(f"'{target}' is a campaign of the store and a path", hint=f"./{target} is the path alone")
    if target in known:
        yield _loaded(store, target, fitted.spec.step)
        return
    if not path.exists():
        raise UsageError(
            f"no folder, campaign file or campaign '{target}'",
            expected="a path, or a campaign of the store: " + ", ".join(known),
            got=target,
        )
    with tempfile.TemporaryDirectory(prefix="thermodata-predict-") as folder:
        passing, campaign = _ingested(session, store, fitted, path, Path(folder))
        yield _loaded(passing, campaign, fitted.spec.step)


def _loaded(store: Store, campaign: str, step_s: float) -> tuple[Dataset, list[str]]:
    from thermodata.view.load import load_dataset

    data = load_dataset(store, campaign, step_s)
    with store.reader() as con:
        rows = con.execute("select test from test where campaign = ? order by rowid", [campaign]).fetchall()
    there = {t.test for t in data.tests}
    return data, [f"{campaign}/{row[0]}" for row in rows if row[0] not in there]


def _ingested(session: Session, store: Store, fitted: FittedModel, path: Path, folder: Path) -> tuple[Store, str]:
    from thermodata.cli.progress import progress_line
    from thermodata.draft.of_logs import campaign_of_logs
    from thermodata.modelling.drivers import names_of
    from thermodata.store import Store
    from thermodata.store.ingest.run import ingest
    from thermodata.store.trace.replan import read_campaign

    passing = Store(folder / "store", create=True)
    file = path if path.is_file() else _campaign_file(path)
    with progress_line() as line:
        if file is not None:
            summary = ingest(passing, file, progress=line)
        else:
            first = fitted.spec.campaign_ids[0]
            terms = [t for r in fitted.responses for t in r.terms]
            needed = {n for t in terms for text in t.binding.values() for n in names_of(text)}
            with store.reader() as con:
                known = read_campaign(con, first)
            made = campaign_of_logs(known, path, needed)
            summary = ingest(passing, path / "campaign.yaml", progress=line, campaign=made)
    for loss in summary.losses:
        session.say(f"loss: {loss.get('reason', loss)}")
    return passing, summary.campaign


def _campaign_file(folder: Path) -> Path | None:
    found = [
        p
        for p in sorted(folder.glob("*.y*ml"))
        if p.suffix in (".yaml", ".yml") and "thermodata/campaign/" in p.read_text("utf-8", "replace")[:2000]
    ]
    if len(found) > 1:
        raise UsageError(
            "several campaign files in the folder", where=str(folder), got=", ".join(p.name for p in found)
        )
    return found[0] if found else None
