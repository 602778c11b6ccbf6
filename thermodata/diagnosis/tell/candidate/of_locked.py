"""What the locked tests say of a claim, in words."""

from __future__ import annotations

import math

from thermodata.diagnosis.claims.in_words import in_words, on_locked
from thermodata.diagnosis.claims.probability import probability
from thermodata.diagnosis.claims.rules import LEAST_TESTS
from thermodata.diagnosis.locked.confirmation import Confirmation
from thermodata.diagnosis.weigh.figures import from_to, of_more_than_noise, short, way
from thermodata.diagnosis.weigh.foretold import Foretold, Looked
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.sentences import in_percent

_SAME = 0.02  # of an error: two that differ by less are not told apart
_OTHERWISE = "the effects of the model may act otherwise than by their fitted lags"


def said_by_locked(scored: Scored, held: Confirmation, unit: str, tests: str, *, together: bool) -> str:
    """The errors as scored; where they do not fall, beside them those that the claim holds by. tests: what is left out
    of the open ones, in a word."""
    if held.before is None or held.after is None:
        return ""
    error = f"error goes {from_to(held.before, held.after, unit, 'from', 'to')}"
    figures = f"; on the locked tests{' with all that is claimed' if together else ''} the {error}"
    if held.asked == frozenset():
        all_of_it = "all that is claimed" if together else "it"
        figures = (
            "; it acts little in the locked tests, and was not held against them, but for that they must not get "
            f"twice as bad; with {all_of_it} their {error}"
        )
    way_of = _in_one_way(scored, scored.looked, tests) if scored.looked is not None else ""
    shape = held.on(held.asked)
    if shape is not None and not Foretold(held.before, held.after, held.changed).falls:
        acts = " where it acts" if shape.tests is not None and len(shape.tests) < len(held.shapes) else ""
        figures += (
            f" from their first samples on, and{acts} {from_to(shape.before, shape.after, unit, 'from', 'to')} with a "
            "free offset a test"
        )
    elif way_of:
        figures += " from their first samples on"
    return figures + way_of + _as_fitted(held, unit)


def stands_for(scored: Scored, held: Confirmation) -> str | None:
    """Why a claim stands though the locked tests in which it acts get no better with all that is claimed; None where
    they do, or none of them was asked."""
    shape, looked = held.on(held.asked), scored.looked
    if shape is None or looked is None or shape.after < shape.before:
        return None
    falls = [f for f in looked.saying if f.falls]
    if not falls:
        return "what is left there to be foretold is too little to speak against it"
    freed = looked.foretold in falls
    where = f"where {_OTHERWISE}" if freed else "with it alone, beside all else that is claimed"
    said = f"their error {in_words(looked.foretold if freed else falls[0], looked.unit)} {where}"
    if not looked.bears_out:
        return f"{said}, less than a cause mostly takes away, but the open tests outweigh that"
    return f"{said}, and only what lets it fall in neither way is refused" if freed else said


def _as_fitted(held: Confirmation, unit: str) -> str:
    """What the model as it is fitted leaves there, where that says otherwise than a refit to all open tests does."""
    if held.stands is None or held.before is None or math.isclose(held.stands, held.before, rel_tol=_SAME):
        return ""
    return (
        f" (before is the model once it is fitted to all open tests; as it is fitted it leaves {short(held.stands)} "
        f"{unit} there from first samples on)"
    )


def _in_one_way(scored: Scored, looked: Looked, tests: str) -> str:
    """How much of it the locked tests bear out, where that is not all."""
    added = looked.added
    if added is not None and len(looked.saying) > 1 and added.falls != looked.foretold.falls:
        if looked.foretold.falls:
            falls = in_words(added, looked.unit)
            return f": added as it stands the error {falls}, and they bear it out only where {_OTHERWISE}"
        return f", which bear it out as it stands, and not where {_OTHERWISE}"
    if looked.bears_out:
        return ""
    return f"; {on_locked(looked)}, which is less than a cause mostly takes away, but {_what_outweighs(scored, tests)}"


def _what_outweighs(scored: Scored, tests: str) -> str:
    """What of the open tests outweighs locked ones that speak against a claim."""
    count = int(scored.acts.sum())
    gain = f", with a gain that differs by {in_percent(scored.spread)}" if count >= LEAST_TESTS else ""
    of = of_more_than_noise(scored.drop, scored.error_before, scored.error_after)
    falls = f"{way(scored.error_before, scored.error_after)} by {in_percent(scored.drop)}{of}"
    return (
        f"the open ones outweigh that: there the error {falls} in the {count} {tests if count > 1 else tests[:-1]} "
        f"in which it acts{gain}, so that, all weighed, its probability is {in_percent(probability(scored))}"
    )
