"""What a candidate's probability hangs on, and what locked tests and other axes say of it, in words."""

from __future__ import annotations

from thermodata.diagnosis.claims.probability import may_be_another_cause, sharpness
from thermodata.diagnosis.weigh.figures import HARDLY, from_to, of_more_than_noise, way
from thermodata.diagnosis.weigh.foretold import Foretold, Looked
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.places import heat_at
from thermodata.schema.words.sentences import in_percent


def in_short(scored: Scored) -> str:
    """What its probability hangs on."""
    of = of_more_than_noise(scored.drop, scored.error_before, scored.error_after)
    by = f" by {in_percent(scored.drop)}{of}" if scored.drop >= HARDLY else ""
    falls = f"where it acts the error {way(scored.error_before, scored.error_after)}{by}"
    beaten = scored.beaten and scored.candidate.around
    more = ["a sharper effect stands beside it, and leaves what is slow, as the air is"] if beaten else []
    if scored.candidate.passive:
        more.append("it reads a body that makes no heat, one beside the machine, or one whose place nobody declared")
    if scored.candidate.kin == "part":
        more.append("the model reads it already, together with others")
    if scored.candidate.of_holder:
        more.append("it reads the tool, or what holds the probes, which warms with all in the working space")
    if scored.candidate.of_source and not scored.candidate.unread:
        more.append("it reads a part that makes heat itself, which speaks for it")
    if may_be_another_cause(scored.candidate):
        more.append(f"what it reads does not tell it from {heat_at(scored.candidate.unread, ' or ')}")
    more += [also_missing(scored)] if scored.also_on else []
    if scored.looked is not None and scored.looked.saying:
        more.append(on_locked(scored.looked))
    return "; ".join([f"its evidence is {sharpness(scored):.2f} a sample, and {falls}", *more])


def on_locked(looked: Looked) -> str:
    """'on the locked tests, with a free offset a test, the error falls by 60 % (1.00 -> 0.40 um)', or in each of two
    ways: this is not the error as tests are scored, from their first samples on."""
    first, added = looked.foretold, looked.added
    acts = "" if first.tests is None else " in which it acts"
    error = f"on the locked tests{acts}, with a free offset a test, the error"
    if len(looked.saying) < 2 or added is None:
        return f"{error} {in_words(looked.saying[0], looked.unit)}"
    return (
        f"{error} {in_words(added, looked.unit)} with it added as it stands, and {in_words(first, looked.unit)} where "
        "the effects of the model may act otherwise than by their fitted lags"
    )


def in_words(of: Foretold, unit: str) -> str:
    """'falls by 60 % (1.00 -> 0.40 um)', 'hardly changes (...)', 'rises by 20 % (...)'."""
    if of.falls:
        said = f"falls by {in_percent(of.fall)}{of_more_than_noise(of.fall, of.before, of.after)}"
    else:
        rises = of.after > 1.005 * of.before > 0
        said = f"rises by {in_percent(of.after / of.before - 1)}" if rises else "hardly changes"
    return f"{said} ({from_to(of.before, of.after, unit)})"


def also_missing(scored: Scored) -> str:
    """'dX misses it as well (97 %)', for each other axis; what is improbable there speaks for nothing."""
    return " and ".join(
        f"{channel} {'misses it as well' if p > 0.5 else 'hardly misses it'} ({in_percent(p)})"
        for channel, p in scored.also_on
    )
