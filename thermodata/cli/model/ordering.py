"""Orders of a model's transfer functions: all that were tried, by FIT on left-out tests."""

from __future__ import annotations

from pathlib import Path

import click

from thermodata.cli.terminal import completing
from thermodata.cli.terminal.common import Session, command, plain
from thermodata.report.text.table import table


@command("orders")
@click.argument("model", shell_complete=completing.models)
@click.option("--method", type=click.Choice(["varpro", "oe", "arx"]), help="In place of the model file's.")
def orders_command(session: Session, model: str, method: str | None) -> None:
    """Try the orders of MODEL's transfer functions.

    Each by its free-run FIT on tests left out in turn (parts of the test, where there is one only), which the choice
    goes by, and on those that were fitted, which it never does. Nothing is saved.
    """
    from thermodata.cli.terminal.progress import counting_line
    from thermodata.modelling.run import orders
    from thermodata.schema.files.load import load_model
    from thermodata.store.base.counting import watched
    from thermodata.store.catalogue.models.fits import find_model

    store = session.store()
    is_file = model.endswith((".yaml", ".yml")) or Path(model).is_file()
    spec = load_model(Path(model)) if is_file else find_model(store, model).spec
    with counting_line() as tell, watched(tell):
        tried = orders(store, spec, method=method, base=Path(model).parent if is_file else None)
    rows = [plain(row) for row in tried]
    shown = [{**row, "chosen": "<-" if row["chosen"] else ""} for row in rows]
    many = len({row["response"] for row in rows}) > 1
    columns = [("response", "response")] if many else []
    late = any(row["delay"] for row in rows)
    columns += [
        ("effect", "effect"),
        ("method", "method"),
        ("numerator", "numerator"),
        ("denominator", "denominator"),
        *([("delay", "delay")] if late else []),
        ("fit_left_out", "FIT left out [%]"),
        ("fit_worst", "worst [%]"),
        ("fit_calibration", "FIT calibration [%]"),
        ("chosen", ""),
        ("why", "refused for"),
    ]
    session.answer(rows, lambda: table(shown, columns))
