"""`models`: what versions of which models the store holds."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from thermodata.cli.look.look import campaign_option
from thermodata.cli.terminal.common import Session, command
from thermodata.errors import unknown_name
from thermodata.report.text.table import table
from thermodata.report.words.numbers import number

if TYPE_CHECKING:
    from thermodata.view.lists.models import ModelRow

MOST_LETTERS = 300  # of effects or responses: a dozen with long names, folded


@command("models")
@campaign_option
def models_command(session: Session, campaign: str | None) -> None:
    """List the models: versions, effects, errors and verdicts.

    The newest version first; "fitted last" marks the one that is taken where a command or page is told none.
    """
    from thermodata.view.lists.models import fitted_last, model_rows

    rows = model_rows(session.store())
    last = fitted_last(rows).model if rows else None
    if campaign is not None:
        with session.store().reader() as con:
            known = [name for (name,) in con.execute("select campaign from campaign order by 1").fetchall()]
        if campaign not in known:
            raise unknown_name("campaign", campaign, known)
    kept = [m for m in rows if campaign is None or campaign in m.campaigns]
    found = [{**_answer_of(m), "fitted_last": m.model == last} for m in kept]
    session.answer(found, lambda: _text(found) if found else "no model was fitted yet")


def _answer_of(model: ModelRow) -> dict[str, Any]:
    return {key: value for key, value in asdict(model).items() if key != "fitted"}


def _text(rows: list[dict[str, Any]]) -> str:
    known = {row["model"]: row for row in rows}
    shown = [
        {
            **row,
            "effects": _effects(row, known.get(row["parent"])),
            "campaigns": ", ".join(row["campaigns"]),
            "responses": ", ".join(row["responses"]),
            "verification_um": _verification(row),
            "made": f"{row['created_at']:%Y-%m-%d %H:%M}",
            "stale": "yes" if row["stale"] else "",
            "fitted": "last" if row["fitted_last"] else "",
        }
        for row in rows
    ]
    heads = ("name", "version", "model", "campaigns", "responses", "effects", "calibration_um", "verification_um")
    named = {"calibration_um": "calibration", "verification_um": "verification", "tests": "of tests"}
    tail = ("unit", "verdict", "made", "tests", "stale", "fitted")
    columns = [(key, named.get(key, key)) for key in (*heads, *tail)]
    return table(shown, columns, widest=MOST_LETTERS)


def _verification(row: dict[str, Any]) -> str:
    return number(row["verification_um"]) + (" (in-sample)" if row["in_sample"] else "")


def _effects(row: dict[str, Any], parent: dict[str, Any] | None) -> str:
    """Of a version what it has more and less than the one that it came from, for a list of ten effects is long."""
    if parent is None or parent["name"] != row["name"] or parent["version"] == row["version"]:
        return ", ".join(row["effects"])
    now, before = Counter(row["terms"]), Counter(parent["terms"])
    changes = [
        *(f"+ {name}" for name in (now - before).elements()),
        *(f"- {name}" for name in (before - now).elements()),
    ]
    return f"version {parent['version']} {' '.join(changes)}" if changes else f"those of version {parent['version']}"
