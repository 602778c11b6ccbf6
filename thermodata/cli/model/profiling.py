"""Profiles of a model's time constants: how far the tests let each of them go."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from thermodata.cli.terminal.common import Session, command
from thermodata.cli.terminal.stored_model import resolve
from thermodata.report.text.table import table
from thermodata.report.words.numbers import number

if TYPE_CHECKING:
    from thermodata.modelling.seen.profiles import Curve, Profiles


@command("profiles")
@click.argument("model")
@click.option("--curves", is_flag=True, help="The error at each value, too.")
def profiles_command(session: Session, model: str, curves: bool) -> None:
    """Show how far the tests let each time constant of MODEL go.

    All else is fitted anew at each value of it. Where a test is too short for a lag, its interval is open at one end.
    Time constants that the tests can't tell apart are named, with the hours of cooling that are missing.
    """
    from thermodata.modelling.run import profiles

    store = session.store()
    found = profiles(store, resolve(store, model))
    session.answer(found.to_json(), lambda: _text(found, curves))


def _text(found: Profiles, curves: bool) -> str:
    many = len({c.response for c in found.curves}) > 1
    columns = [("response", "response")] if many else []
    columns += [
        ("parameter", "parameter"),
        ("value", "value"),
        ("unit", "unit"),
        ("quadratic", "95 % quadratic"),
        ("profile", "95 % by profile"),
    ]
    parts = [table([_row(c) for c in found.curves], columns) if found.curves else "nothing was searched"]
    parts += [f"! {said}" for said in found.said]
    if curves:
        for c in found.curves:
            rows = [{"value": value, "rms": rms} for value, rms in c.curve]
            parts.append(f"{c.parameter}\n" + table(rows, [("value", f"value [{c.unit}]"), ("rms", "RMS left")]))
    return "\n\n".join(parts)


def _row(curve: Curve) -> dict[str, Any]:
    ends = (curve.profile_low, curve.profile_high)
    low, high = ("" if end is None else number(end) for end in ends)
    return {
        "response": curve.response,
        "parameter": curve.parameter,
        "value": curve.value,
        "unit": curve.unit,
        "quadratic": f"{number(curve.low)} … {number(curve.high)}",
        "profile": "the same" if curve.quadratic else f"{low} … {high}".strip() if any(ends) else "open",
    }
