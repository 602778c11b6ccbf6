"""Errors of what a verdict names, in words: on left-out tests, and beside what; on locked ones, and by what measure."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from thermodata.report.words.numbers import number
from thermodata.schema.words.sentences import counted, listed

if TYPE_CHECKING:
    from thermodata.schema.answers.candidate import Candidate

NEARLY_ALL = 0.8
"""A test that makes this share of the squared error on left-out tests is told by itself,"""
LEAST_TESTS = 3
"""of so many at least,"""
SAME = 0.02
"""where the tests make the error that is told."""
ONCE_FITTED = "once that model is fitted to all open tests"
"""Of the model that stands beside the user's own: what it gains is by more tests, and by no effect."""
LAGS = "; this is with one lag for each effect: add may give it a second one, and tells what that version leaves"
"""Of what is foretold to get no better than the model as it is fitted."""
OTHERWISE = 1.5
"""Of locked tests: a share that is left as scored, so many times that of the shape, is told with the latter."""


def left_out_tests(some: Sequence[Candidate]) -> str:
    """'left-out tests', or 'left-out parts of 2 tests' where these are too few to leave one out whole."""
    parts = next((c.left_out for c in some if c.left_out), [])
    tests = len({(p.campaign, p.test) for p in parts})
    return "left-out tests" if tests == len(parts) else f"left-out parts of {counted(tests, 'test')}"


def left_out_errors(some: Sequence[Candidate], left: float | None, together: float | None = None) -> str:
    """Of the user's own model, and with all of some added. left: the error of the former; together: of the latter. In
    answers of older versions, which have none of these, what each gives beside the others."""
    if left is not None and together is not None:
        return _from_to(f"error on {left_out_tests(some)}{_all_of(some)}", some, left, together)
    return _each_beside(some, left)


def _all_of(some: Sequence[Candidate]) -> str:
    return "" if len(some) == 1 else " with both:" if len(some) == 2 else f" with all {len(some)}:"


def _each_beside(some: Sequence[Candidate], left: float | None) -> str:
    error = f"error on {left_out_tests(some)}"
    if len(some) == 1:
        others = listed(beside(some[0], left))
        return _of_one(error + (f" beside {others}:" if others else ""), some[0])
    ids = {c.id for c in some}
    if all(set(beside(c, left)) == ids - {c.id} for c in some):
        each = [_of_one(c.effect, c) for c in some]
        apart = len({number(c.rmse_um_after) for c in some}) > 1
        turns = " (fitted in turn, the others as they stand, so these end apart)" if apart else ""
        return f"{error}, each beside the other{'s' if len(some) > 2 else ''}: {', '.join(each)}{turns}"
    each = [_of_one(f"{c.effect} {_beside_or_alone(beside(c, left))}", c) for c in some]
    return f"{error}: {', '.join(each)}"


def _beside_or_alone(others: Sequence[str]) -> str:
    return f"beside {listed(others)}" if others else "alone"


def beside(one: Candidate, left: float | None) -> list[str]:
    """Ids of the candidates that its errors on left-out tests have in the model too, without it and with it, as its
    sentence names them; empty where they are of the user's own model. left: the error of that [um]."""
    if one.beside is not None:
        return one.beside
    before = one.rmse_um_before
    if before is None or (left is not None and math.isclose(before, left, rel_tol=1e-6)):
        return []
    found = re.search(r", beside (.+?), the error ", one.why)
    return found[1].split(" and ") if found else []


def locked_errors(claims: Sequence[Candidate]) -> str:
    """Locked tests are scored with all claims together, from their first samples; a claim is judged by its shape."""
    said = _locked_errors(claims)
    judged = said and claims[0].locked_tests_asked != 0
    return said + LAGS if judged and not on_locked(claims[0])[1] else said


def _locked_errors(claims: Sequence[Candidate]) -> str:
    before, after = claims[0].locked_rmse_um_before, claims[0].locked_rmse_um_after
    if before is None or after is None:
        return ""
    all_of = _all_of(claims)
    if claims[0].locked_tests_asked == 0:
        acts = "it hardly acts" if len(claims) == 1 else "they hardly act"
        of, them = ("its", "it") if len(claims) == 1 else ("their", "them")
        said = f"{acts} in the locked tests (under a fifth of {of} largest), so these can't bear {them} out"
        return f"; {said}; they were opened to see that they do not get twice as bad: {on_locked(claims[0])[0]}"
    figures, better = on_locked(claims[0])
    shape = claims[0].locked_shape_um_before, claims[0].locked_shape_um_after
    if after < before and not _shape_says_more(after / before, *shape):
        return f"; locked tests{all_of} {figures}" + ("" if better else ": with the model as it is fitted it is less")
    if shape[0] is None or shape[1] is None:
        return f"; locked tests{all_of} (judged by their shape where it acts; from their first samples on: {figures})"
    course = f"{number(shape[0])} -> {number(shape[1])} um"
    if after < before:
        by = f"judged by their shape where it acts, {course}; from their first samples on: {figures}"
        return f"; locked tests{all_of} ({by})"
    if shape[1] >= shape[0]:
        if not better:
            return f"; locked tests get worse{all_of} ({figures}, by their shape {course}){_all_the_same(claims)}"
        than = "worse" if after > before and shape[1] > shape[0] else "no better"
        return (
            f"; locked tests{all_of} {figures}, by their shape {course} from there on: they get better than with the "
            f"model as it is fitted, and {than} than {ONCE_FITTED}"
            f"{_all_the_same(claims)}"
        )
    if better:
        scored = f"as they are scored, from their first samples on, {figures}"
    else:
        scored = (
            f"{'worse' if after > before else 'no better'} as they are scored, from their first samples on ({figures})"
        )
    return (
        f"; locked tests get better{all_of} by their shape where it acts ({course}), which a claim is judged by, and "
        f"{scored}"
    )


def _all_the_same(claims: Sequence[Candidate]) -> str:
    """', so they do not bear it out as it would be added; it is claimed all the same, for ...': by which rule; '' of an
    answer of an older version."""
    reasons = [(c, c.stands_for) for c in claims if c.stands_for is not None]
    if not reasons:
        return ""
    if len(claims) == 1:
        return f", so they do not bear it out as it would be added; it is claimed all the same, for {reasons[0][1]}"
    each = ", and ".join(f"{c.effect}, for {why}" for c, why in reasons)
    return f", so they do not bear all out as these would be added; they are claimed all the same: {each}"


def on_locked(one: Candidate) -> tuple[str, bool]:
    """('1.56 (0.777 once that model is fitted to all open tests) -> 0.830 um', whether they get better than with
    the model as it is fitted): before is the model that the user has; the same fitted to all open tests stands beside
    it where it says otherwise, and alone in answers of older versions, which have no other."""
    before, after, fitted = one.locked_rmse_um_before, one.locked_rmse_um_after, one.locked_rmse_um_fitted
    if before is None or after is None:
        return "", False
    return from_fitted(fitted, before, after), after < users_own(fitted, before)


def from_fitted(fitted: float | None, refitted: float, after: float) -> str:
    """The errors of a model as it is fitted, refitted to all open tests, and with more: the first where it is known and
    says otherwise than the second."""
    own = users_own(fitted, refitted)
    beside = "" if own == refitted else f" ({number(refitted)} {ONCE_FITTED})"
    return f"{number(own)}{beside} -> {number(after)} um"


def users_own(fitted: float | None, refitted: float) -> float:
    """The error of the model as it is fitted, or of its refit where that says the same."""
    return refitted if fitted is None or math.isclose(fitted, refitted, rel_tol=SAME) else fitted


def _shape_says_more(left: float, before: float | None, after: float | None) -> bool:
    """Whether a fall as scored, to the share `left`, looks small for a claim that takes most of the shape away: what
    remains is where tests start."""
    return bool(before) and after is not None and OTHERWISE * after / (before or 1.0) <= left


def _of_one(what: str, one: Candidate) -> str:
    return _from_to(what, [one], one.rmse_um_before, one.rmse_um_after)


def _from_to(what: str, some: Sequence[Candidate], before: float | None, after: float | None) -> str:
    """Over all tests an error may rise though it falls where an effect acts."""
    if before is None or after is None:
        return f"{what} not known"
    figures = f"{number(before)} -> {number(after)} um"
    if after < before:
        return f"{what} {figures}"
    falls = [next((r.value for r in one.rungs if r.name == "fall"), None) for one in some]
    if all(fall is not None and fall <= 0 for fall in falls):
        of = "it" if len(some) == 1 else "them"
        return f"{what} (does not fall, though the evidence speaks for {of}: {figures})"
    acts = "it acts" if len(some) == 1 else "they act"
    return f"{what} (falls where {acts} only; over all: {figures}{but_for_one_test(some, before)})"


def but_for_one_test(some: Sequence[Candidate], before: float) -> str:
    """', and 0.85 -> 0.28 um without table, which the others foretell badly': of an effect of the model that acts in
    one test alone the others tell nothing, and what they foretell of that test says nothing of a candidate."""
    parts = some[0].left_out if len(some) == 1 else []
    squares = {
        test: [(r.rmse_um_before**2, r.rmse_um_after**2) for r in parts if r.test == test]
        for test in dict.fromkeys(r.test for r in parts)
    }
    whole = math.sqrt(sum(b for of in squares.values() for b, _ in of) / len(parts)) if parts else 0.0
    if len(squares) < LEAST_TESTS or not math.isclose(whole, before, rel_tol=SAME):
        return ""
    most = max(squares, key=lambda test: sum(b for b, _ in squares[test]))
    if sum(b for b, _ in squares[most]) < NEARLY_ALL * len(parts) * whole**2:
        return ""
    others = [pair for test, of in squares.items() if test != most for pair in of]
    left = [math.sqrt(sum(pair[i] for pair in others) / len(others)) for i in (0, 1)]
    return f", and {number(left[0])} -> {number(left[1])} um without {most}, which the others foretell badly"
