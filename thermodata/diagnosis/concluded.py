"""What a diagnosis comes to: the judgement once the locked tests had their say, and the errors that are told of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from thermodata.diagnosis.case import Case
from thermodata.diagnosis.locked.confirm import confirm
from thermodata.diagnosis.locked.confirmation import Confirmation
from thermodata.diagnosis.locked.left_on_locked import contradicted
from thermodata.diagnosis.locked.unlocking import Look, Unlocked, unlocked
from thermodata.diagnosis.tell.of_version.in_version import told_by_versions
from thermodata.diagnosis.tell.of_version.together import Refit, left_with_named, told_alike
from thermodata.diagnosis.verdict.as_modelled import AsModelled, as_modelled, refined
from thermodata.diagnosis.verdict.investigate import Investigation
from thermodata.diagnosis.verdict.judge import parts_offered
from thermodata.diagnosis.verdict.judged import Judged, Judgement
from thermodata.plugin import Float1D


@dataclass(frozen=True, slots=True)
class Concluded:
    """judgement: once the locked tests had their say. confirmation: of what is claimed, on the locked tests; None where
    nothing is. on_locked: whether it is only the locked tests that miss something. stands: what the model leaves as it
    stands, where nothing is missing. named: mean square error of each left-out test with all that is named; None where
    nothing is. turned: the keys of the locked tests in which a probe is turned. looks: each time that locked tests were
    opened."""

    investigation: Investigation
    judgement: Judgement
    confirmation: Confirmation | None
    on_locked: bool
    stands: AsModelled | None
    named: Float1D | None
    turned: tuple[tuple[str, str], ...]
    looks: tuple[Look, ...]


def concluded(case: Case, left_on_locked: float | None) -> Concluded:
    """left_on_locked: the error on the locked tests, where it is known already."""
    opened = unlocked(case.investigated, case.fits, case.locked)
    investigation, judgement = opened.investigation, opened.judgement
    confirmation = _confirmation(case, opened) if judgement.claims else None
    on_locked = False
    if not judgement.claims:
        by_open = parts_offered(judgement, investigation.conclude)
        judgement = contradicted(by_open, left_on_locked, case.response, case.locked)
        on_locked = judgement is not by_open
    stands = None
    if judgement.verdict in ("none", "refine"):
        stands = as_modelled(
            investigation.problem,
            investigation.selection,
            investigation.measure,
            offers=judgement.verdict == "none",
        )
        judgement = refined(judgement, stands, investigation.measure)
    fits = case.fits(())
    judgement = told_by_versions(judgement, fits.of, case.tests)
    # errors on left-out tests are told beside the slips, with what is named and without
    beside = case.fits_beside_slips()
    refit = beside.of if beside is not None else _of_claims(confirmation) or fits.of
    named = left_with_named(investigation, judgement, refit, case.data, case.tests)
    return Concluded(
        told_alike(investigation, judgement, named),
        judgement,
        confirmation,
        on_locked,
        stands,
        named,
        opened.turned,
        opened.looks,
    )


def _confirmation(case: Case, opened: Unlocked) -> Confirmation:
    claims = opened.judgement.claims
    chosen = [c.scored.candidate for c in claims]
    spec, refitted = case.fitted.spec, case.sound.fitted
    found = confirm(spec, case.index, case.data, chosen, case.tests, opened.locked, refitted, case.response)
    return replace(found, asked=_tests_asked(claims))


def _of_claims(confirmation: Confirmation | None) -> Refit | None:
    """The fit with all that is claimed, where it is made already."""
    made = None if confirmation is None else confirmation.fitted
    return None if made is None else lambda claimed: made


def _tests_asked(claims: Sequence[Judged]) -> frozenset[tuple[str, str]] | None:
    """The keys of the locked tests in which one of them acts; None: all."""
    tests = [c.scored.looked.foretold.tests for c in claims if c.scored.looked is not None]
    found = [t for t in tests if t is not None]
    return frozenset[tuple[str, str]]().union(*found) if found and len(found) == len(tests) else None
