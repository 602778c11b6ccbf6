"""What a diagnosis found wrong with the logs, heeded by the next version of a model."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.modelling.inputs.roles import in_full, resolve_roles
from thermodata.modelling.versions.made_without import MADE_WITHOUT
from thermodata.schema.answers.diagnosis import ClockMoved, PutRight
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset


def heeding(spec: Model, data: Dataset, found: PutRight | None) -> tuple[Model, list[str]]:
    """(the model without the tests whose log is wrong, what was done and what is left to do).

    A test in which a probe is turned, or a clock is off by itself, would be fitted as it was logged. Where no other
    test is left to calibrate on, the model stays as it is.
    """
    if found is None:
        return spec, []
    notes = [_of_all(c.source, c.moved_s) for c in found.clocks if not c.test]
    turned = dict.fromkeys(found.left_out, "its probe is turned; mend it in the campaign file, ingest, and fit again")
    late = {(c.campaign, c.test): _of_one(c.campaign, c.test, found.clocks) for c in found.clocks if c.test}
    wrong = {**late, **turned}
    roles = resolve_roles(spec, data)
    kept = [key for key in roles.calibrate if key not in wrong]
    gone = [key for key in (*roles.calibrate, *roles.verify) if key in wrong]
    if not gone or not kept:
        return spec, notes
    verify = [key for key in roles.verify if key not in wrong]
    notes += [f"{MADE_WITHOUT} {key[1]}: {wrong[key]}" for key in gone]
    return spec.model_copy(update={"calibrate_on": in_full(kept), "verify_on": in_full(verify)}), notes


def _of_one(campaign: str, test: str, clocks: Sequence[ClockMoved]) -> str:
    """Of a test in which clocks are off by themselves, each with all that it is moved by there."""
    by_s: dict[str, float] = {c.source: 0.0 for c in clocks if (c.campaign, c.test) == (campaign, test)}
    for c in clocks:
        if c.source in by_s and (not c.test or (c.campaign, c.test) == (campaign, test)):
            by_s[c.source] += c.moved_s
    off = " and ".join(f"the clock of {source} is off in it by {s / 60:+.0f} min" for source, s in by_s.items())
    mended = ", ".join(f"{source}: {s:.0f} s" for source, s in by_s.items())
    sound = ", ".join(f"{source}: 0 s" for source in by_s)
    return (
        f"{off}, the diagnosis says. If so, declare at this test clocks: {{{mended}}}; if it was right, clocks: "
        f"{{{sound}}}; then ingest, and fit again"
    )


def _of_all(source: str, moved_s: float) -> str:
    return (
        f"the clock of {source} is off by {moved_s / 60:+.0f} min, and this is fitted to its log as it is: declare "
        "clock: {offset: ...} in the campaign file, ingest, and fit again"
    )
