"""`diagnose`: which physical effect is missing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from thermodata.cli.common import Session, command, in_units_of
from thermodata.cli.fitting import resolve, spots_text
from thermodata.cli.table import table
from thermodata.report.words import duration, number, verdict_sentence

if TYPE_CHECKING:
    from thermodata.schema.result import Diagnosis


@command("diagnose")
@click.argument("model")
@click.option("--top", default=8, show_default=True, type=click.IntRange(1), help="Most candidates of the table.")
def diagnose_command(session: Session, model: str, top: int) -> None:
    """Say which physical effect MODEL misses.

    Or that none is missing, or that these tests can't tell.

    A candidate is claimed only if all evidence holds; locked tests are opened for claims only, and counted.
    """
    from thermodata.cli.progress import counting_line
    from thermodata.diagnosis.run import diagnose

    store = session.store()
    with counting_line() as tell:
        found = diagnose(store, resolve(store, model), tell)
    session.answer(found, lambda: in_units_of(session, found.response, diagnosis_text(found, top)))


def diagnosis_text(found: Diagnosis, top: int = 8) -> str:
    """A diagnosis for a person."""
    share = found.explainable
    head = verdict_sentence(found) + (
        f"\nresidual {number(found.rmse_um)} um, noise {number(found.noise_um)} um"
        + (f", {100 * share:.0f} % of it could be explained" if share is not None else "")
    )
    parts = [head]
    if found.candidates:
        rows = [{**c.model_dump(), "claimed": "yes" if c.claimed else ""} for c in found.candidates[:top]]
        parts.append(
            table(
                rows,
                [
                    ("rank", "#"),
                    ("id", "candidate"),
                    ("family", "family"),
                    ("claimed", "claimed"),
                    ("p_value", "p"),
                    ("rmse_um_before", "before [um]"),
                    ("rmse_um_after", "after [um]"),
                    ("equivalent", "can't be told from"),
                ],
                widest=44,
            )
        )
        first = found.candidates[0]
        if first.why:
            parts.append(f"why {first.id}: {first.why}")
    if found.weak_spots:
        parts.append(spots_text(found.weak_spots, most=top))
    if found.artefacts:
        parts.append(
            "artefacts\n"
            + "\n".join(
                f"  ! {a.kind} in {a.campaign}/{a.test} at {duration(a.at_s)}: {number(a.size_um)} um. {a.why}"
                for a in found.artefacts
            )
        )
    if found.unknown:
        hints = found.unknown.model_dump()
        parts.append(
            "what is left behaves like\n"
            + "\n".join(
                f"  {name}: {', '.join(number(v) if isinstance(v, float) else str(v) for v in hints[key])}"
                for name, key in (
                    ("time constants [h]", "time_constants_h"),
                    ("hours of the day", "hours_of_day"),
                    ("states", "states"),
                )
                if hints[key]
            )
        )
    if found.next_test:
        parts.append(f"next test: {found.next_test}")
    return "\n\n".join(parts)
