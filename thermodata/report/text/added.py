"""What an added effect did, as text for a person: in the terminal and in a notebook."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any

from thermodata.modelling.compare.common import on_common
from thermodata.modelling.versions.made_without import MADE_WITHOUT
from thermodata.modelling.versions.same_tests import note_on_the_same_tests
from thermodata.report.collected.lost import lost_sentence
from thermodata.report.text.fit import leveled
from thermodata.report.text.table import prose, table
from thermodata.report.verdict.candidate_errors import ONCE_FITTED
from thermodata.report.words.glossary import explained
from thermodata.report.words.numbers import base_role, change, number, pooled, tests_of_role
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from collections.abc import Mapping

    from thermodata.schema.answers.result import FitResult

_RISES = 1.005  # an error that rises by less is the same


def before_after_text(result: FitResult) -> str:
    """What an added effect did, a row a test; roles pooled below over the tests that both versions predict. First which
    tests it is made without, which may be sound."""
    common = on_common([result.before or [], result.scores])
    before = {(s.campaign, s.test, s.response, s.phase): s for s in result.before or []}
    rows: list[dict[str, Any]] = []
    for s in result.scores:
        old = before.get((s.campaign, s.test, s.response, s.phase))
        if s.phase == "all" and old:
            rows.append({**s.model_dump(), "before": old.rmse_um, "change": change(old.rmse_um, s.rmse_um)})
    names = list(dict.fromkeys(s.response for s in result.scores))
    for role in dict.fromkeys(base_role(row["role"]) for row in rows):
        for name in names:  # responses may be in several units
            was, now = (pooled(some, role, responses=[name]) for some in common)
            pool = {"before": was, "rmse_um": now, "change": change(was, now)}
            rows.append({"test": "all", "role": role, "response": name, **pool})
    columns = [
        ("campaign", "campaign"),
        ("test", "test"),
        ("role", "role"),
        *([("response", "response")] if len(names) > 1 else []),
        ("before", "before [um]"),
        ("rmse_um", "after [um]"),
        ("change", "change"),
    ]
    lost = lost_sentence(result.before or [], result.scores, result.checks)
    left_out = [note for note in result.notes if note.startswith(MADE_WITHOUT)]
    locked = worse_on_locked(result) or _on_locked(result)
    head = "".join(f"{said}\n\n" for said in (*left_out, locked, lost) if said)
    refitted = note_on_the_same_tests(result.notes)
    too = {s.test for s in result.scores if s.role != base_role(s.role)}
    fitted = tests_of_role(common[1], "calibration")
    told = f"all of calibration: {fitted}; fitted too by now, under verification: {listed(sorted(too))}" if too else ""
    were = {s.test for s in result.before or [] if s.role != base_role(s.role)} - too
    once = f"before: fitted too, under verification: {listed(sorted(were))}" if were else ""
    tables = f"{head}{leveled(table(rows, columns))}\n{prose(explained('verification', 'fitted'))}"
    return "\n".join(filter(None, [tables, prose(refitted), told, once]))


def _on_locked(result: FitResult) -> str:
    """What the version leaves on the locked tests that were opened for all that it adds; '' where none were. Of several
    responses nothing here says which it is of, and in which unit."""
    before, after = result.locked_rmse_um_before, result.locked_rmse_um_after
    if before is None or after is None or len(result.responses) > 1:
        return ""
    own = before if result.locked_rmse_um_fitted is None else result.locked_rmse_um_fitted
    beside = "" if own == before else f" ({number(before)} {ONCE_FITTED})"
    return (
        f"locked tests, opened for what the diagnosis claims: {number(own)}{beside} -> {number(after)} um, of this "
        "version as it is"
    )


def worse_on_locked(result: FitResult) -> str:
    """That the locked tests get worse with what the diagnosis claims, though open ones get better; else ''."""
    before, after = result.locked_rmse_um_before, result.locked_rmse_um_after
    own = before if result.locked_rmse_um_fitted is None else result.locked_rmse_um_fitted
    if before is None or own is None or after is None or after <= own * _RISES:
        return ""
    # of several responses nothing here says which it is of, and in which unit
    figures = f"{number(own)} -> {number(after)} um, " if len(result.responses) == 1 else ""
    return (
        "as they are scored, from their first samples on, the locked tests get worse with what the diagnosis claims: "
        f"{figures}{number(after / own, 2)} times as much, as its answer says, which judges by their shape (each "
        "about its own mean). The errors below are of tests that it was fitted to or chosen by, "
        "so ask the locked ones (thermodata confirm tells each) before this version is used"
    )


def made_worse(result: FitResult, units: Mapping[str, str]) -> str | None:
    """A warning where an added effect raised the error of a role, response by response; None where it did not. units:
    of the responses' errors."""
    found = []
    common = on_common([result.before or [], result.scores])
    for role, name in product(("verification", "calibration"), result.responses):
        before, after = (pooled(some, role, responses=[name]) for some in common)
        if before is not None and after is not None and after > before * _RISES:
            whose = f"{name} " if len(result.responses) > 1 else ""
            found.append(f"{whose}{role} {before:.3g} -> {after:.3g} {units.get(name, 'um')}")
    if not found:
        return None
    return (
        f"warning: an error rises with it: {', '.join(found)}; the version before is still there, and its diagnosis "
        "says what speaks for the effect"
    )
