"""The errors of a page, each under its word of the glossary, and the one that heads it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from thermodata.modelling.compare.common import on_common
from thermodata.report.collected.data import ReportData
from thermodata.report.verdict.candidate_errors import ONCE_FITTED, beside, left_out_tests
from thermodata.report.verdict.left_over import in_parts
from thermodata.report.verdict.verdict import claims_of
from thermodata.report.words.glossary import ERRORS, PARTS
from thermodata.report.words.numbers import LITTLE, base_role, pooled, tests_of_role
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.answers.result import Score
from thermodata.schema.words.sentences import listed

MOSTLY = 0.5
"""Of a row's squared error."""


@dataclass(frozen=True, slots=True)
class ErrorRow:
    """One error of a model. word: of the glossary. before: without the last effect, None where there is none.
    tested: whether the fit and the choice of effects have not seen these tests. unit: of the error. of: which of a
    model's several responses it is of, '' where it has one. parts: that parts of tests were left out, and why; '' where
    tests were. refitted: before, fitted to the same tests as after; None where that says nothing else. foretold: of
    which other model a diagnosis foretold it; '' of an error of this one. left_out: what a left-out error is on."""

    word: str
    before: float | None
    after: float
    tested: bool
    note: str
    unit: str = "um"
    of: str = ""
    parts: str = ""
    refitted: float | None = None
    foretold: str = ""
    left_out: str = "left-out tests"

    @property
    def notes(self) -> str:
        return "; ".join(filter(None, [self.foretold, self.note, f"of {self.of}" if self.of else ""]))

    @property
    def compared(self) -> float | None:
        """What the error after is compared with: a fit to more tests is no merit of what was added."""
        return self.before if self.refitted is None else self.refitted

    @property
    def meaning(self) -> str:
        return f"{PARTS}; {self.parts}" if self.parts else ERRORS[self.word]


def error_rows(data: ReportData) -> list[ErrorRow]:
    """From what the model has seen least to what it has seen most; what is not known is left out."""
    rows = [_locked_row(data), _left_out_row(data), _role_row(data, "verification"), _role_row(data, "calibration")]
    return [r for r in rows if r is not None]


def headline_error(rows: Sequence[ErrorRow]) -> ErrorRow | None:
    """The one that tells most of how the model foretells."""
    own = [r for r in rows if not r.foretold]
    return next((r for r in own if r.tested), own[0] if own else None)


def added_claims(data: ReportData) -> list[Candidate]:
    """The claims behind the model's last version that it has by now; empty where none of them was claimed."""
    claims = claims_of(data.reason) if data.reason and data.added else []
    return [c for c in claims if any(re.fullmatch(rf"{re.escape(c.effect)}(_\d+)?", term) for term in data.effects)]


def _all_added(data: ReportData) -> list[Candidate]:
    """The claims of one answer, once the model has them all, for they were judged beside each other; empty where their
    errors are of another fit."""
    claims = added_claims(data)
    its = data.reason_of_fit or data.reason_but_for
    return claims if data.reason and its and len(claims) == len(claims_of(data.reason)) else []


def _foretold(data: ReportData) -> str:
    """'foretold for one lag of each effect: this version has bed_lag2 too'; '' where it is the very fit."""
    if data.reason_of_fit:
        return ""
    return f"foretold for one lag of each effect: this version has {listed(data.reason_but_for)} too"


def _locked_row(data: ReportData) -> ErrorRow | None:
    """Of the claims that were confirmed where all were added, or are claimed now, without and with them."""
    claims = _all_added(data)
    claimed = claims_of(data.diagnosis) if data.diagnosis and not claims else []
    of = _of_response(data, data.reason if claims else data.diagnosis)
    for c in (*claims, *claimed):
        before, after = c.locked_rmse_um_before, c.locked_rmse_um_after
        if after is not None and before is not None:
            # what is claimed, but not added, is no error of this model yet: its own is the one before
            own = before if c.locked_rmse_um_fitted is None else c.locked_rmse_um_fitted
            refitted = "" if own == before else f"{before:.3g} {of.unit} {ONCE_FITTED}"
            if claims:
                told, other = refitted and f"before: {refitted}", before if refitted else None
                scored = data.left_on_locked
                lags, left = _foretold(data) if scored is None else "", after if scored is None else scored
                return ErrorRow("locked", own, left, not lags, told, of.unit, of.response, "", other, lags)
            note = "; ".join(filter(None, [refitted, f"{after:.3g} {of.unit} with what is claimed"]))
            return ErrorRow("locked", None, own, True, note, of.unit, of.response)
    before, after = _of_role(data, "locked")
    return None if after is None else ErrorRow("locked", before, after, True, "", data.unit, _whose(data))


def _left_out_row(data: ReportData) -> ErrorRow | None:
    def row(found: Diagnosis, before: float | None, after: float, lags: str = "") -> ErrorRow:
        of = _of_response(data, found)
        of_this, told = not lags, left_out_tests(found.candidates)
        return ErrorRow("left-out", before, after, of_this, "", of.unit, of.response, in_parts(found), None, lags, told)

    claims, reason = _all_added(data), data.reason
    left = reason.rmse_um if reason else None
    if claims and reason:
        if left is not None and reason.named_rmse_um is not None:
            return row(reason, left, reason.named_rmse_um, _foretold(data))
        # errors beside other candidates are of no model that anybody has
        if len(claims) == 1 and claims[0].rmse_um_after is not None and not beside(claims[0], left):
            return row(reason, claims[0].rmse_um_before, claims[0].rmse_um_after, _foretold(data))
    if data.diagnosis and data.diagnosis.rmse_um is not None:
        return row(data.diagnosis, None, data.diagnosis.rmse_um)
    return None


@dataclass(frozen=True, slots=True)
class _ResponseUnit:
    response: str
    unit: str


def _of_response(data: ReportData, found: Diagnosis | None) -> _ResponseUnit:
    """What a diagnosis tells is of one response, where the other errors are of several."""
    return _ResponseUnit(found.response if found and len(data.responses) > 1 else "", data.unit_of(found))


def _of_role(data: ReportData, role: str) -> tuple[float | None, float | None]:
    """Over the tests that both versions predict; of the last alone, over all of its own, where there is none."""
    before, after = (pooled(some, role, responses=data.told_together) for some in on_common([data.before, data.scores]))
    return (before, after) if after is not None else (None, pooled(data.scores, role, responses=data.told_together))


def _role_row(data: ReportData, role: str) -> ErrorRow | None:
    before, after = _of_role(data, role)
    if after is None:
        return None
    in_sample = {f"{s.campaign}/{s.test}" for s in data.scores if base_role(s.role) == role and s.role != role}
    overlap = {c.name.partition(":")[2] for c in data.checks if c.name.startswith("overlap:")}
    why = "some hold samples of calibration tests" if in_sample <= overlap else "they took part in the choice"
    common = on_common([data.before, data.scores])[1]
    tests = tests_of_role(common, role) or tests_of_role(data.scores, role)
    if role == "calibration":
        return ErrorRow("fitted", before, after, False, tests, data.unit, _whose(data))
    scores = common if tests_of_role(common, role) else data.scores
    some = {f"{s.campaign}/{s.test}" for s in scores if base_role(s.role) == role} - in_sample
    own = f"{listed([n.partition('/')[2] for n in sorted(in_sample)])} " if some else ""
    level = f"mostly the level of {listed(levels)}" if (levels := _off_by_level(data, scores, role)) else ""
    fitted = f"{own}fitted too by now: {why}" if in_sample else ""
    note = "; ".join(filter(None, [tests, fitted, data.versions[-1].refitted if data.versions else "", level]))
    return ErrorRow("verification", before, after, not in_sample, note, data.unit, _whose(data))


def _off_by_level(data: ReportData, scores: Sequence[Score], role: str) -> list[str]:
    """Tests of a role that begin with something on which may have run before (check on_at_start), where their levels
    make most of the row's squared error; those that make little of it are left out."""
    off = {c.name: 1.0 - (c.value or 0.0) ** 2 for c in data.checks if c.name.startswith("on_at_start:")}
    whole, levels = 0.0, dict[str, float]()
    for s in scores:
        if s.phase == "all" and base_role(s.role) == role and s.response in data.told_together:
            of = "" if len(data.responses) == 1 else f"{s.response}/"
            squares = s.n * (s.rmse_um or 0.0) ** 2
            whole += squares
            share = off.get(f"on_at_start:{of}{s.campaign}/{s.test}", 0.0)
            levels[s.test] = levels.get(s.test, 0.0) + share * squares
    if sum(levels.values()) <= MOSTLY * whole:
        return []
    return [test for test, squares in sorted(levels.items()) if squares > LITTLE * whole]


def _whose(data: ReportData) -> str:
    return listed(data.told_together) if len(data.responses) > 1 else ""
