"""What is to be known of a claim beside its figures: what it breaks and outweighs, what else the heat may be."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.claims.probability import CLAIMED, limit_of, probability, sharpness
from thermodata.diagnosis.claims.refinement import SURE
from thermodata.diagnosis.claims.rules import rules
from thermodata.diagnosis.weigh.figures import of_more_than_noise, way
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.sentences import in_percent, listed
from thermodata.view.grid.dataset import TestData

# what a claim may break where it is evident, by the name of the rule
_OUTWEIGHED = {
    "gain": "that its gain differs",
    "others": "that no other test foretells it",
    "worth": "that it explains so little",
}
_CUTTING = "cutting"
_NOTHING_IS_CUT = ("spindle", "spectrum", "linear_axis", "rotary_axis", "etve")
_SHOWN = 3  # tests
_DRIVES_A_MOTOR = ("power", "load", "current", "torque")


def in_spite_of(scored: Scored, measure: Measure, unit: str) -> str:
    """What stands in these figures against a claim and is outweighed, for it is evident in each test by itself."""
    lifted = [r.name for r in rules(scored, measure, unit) if r.holds and not r.asked]
    words = {"fall": f"that the error {_fall_in_words(scored)}", **_OUTWEIGHED}
    said = " and ".join(words[name] for name in lifted if name in words)
    evident = f"its evidence, {sharpness(scored):.2f} a sample, outweighs"
    return f"; {evident} {said}: the effects of the model take part of what it does for their own" if said else ""


def _fall_in_words(scored: Scored) -> str:
    """As its figures say: 'does not fall', 'hardly falls', 'falls by 10 % only'."""
    said = way(scored.error_before, scored.error_after)
    of = of_more_than_noise(scored.drop, scored.error_before, scored.error_after)
    return f"{said} by {in_percent(scored.drop)}{of} only" if said == "falls" else said


def placeless_limit(scored: Scored) -> str:
    """Of a claim that is less probable than one of a declared place must be: by which limit it stands; else ''."""
    if probability(scored) >= CLAIMED or not scored.candidate.placeless:
        return ""
    return (
        f"; no temperature has a declared place, so it names a channel and no part of the machine, and a claim asks "
        f"{in_percent(limit_of(scored))} in place of {in_percent(CLAIMED)}: declare 'at' of the channels to ask for "
        "more"
    )


def where_nothing_is_cut(scored: Scored, tests: Sequence[TestData]) -> str:
    """Of a cause by its heat of cutting: tests in which it acts, though by their kind nothing is cut in them; else
    ''."""
    names = _without_a_cut(scored, tests)
    if not names:
        return ""
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return (
        f"; it acts in {', '.join(names[:_SHOWN])}{more}, where nothing is cut: what heats there is what "
        "the spindle itself loses, in its motor first"
    )


def heats_its_motor(scored: Scored, tests: Sequence[TestData]) -> bool:
    """Whether a cause by its heat of cutting acts where nothing is cut, and in no test of cutting: then the same heat
    in the spindle's motor comes first, whatever reads that."""
    if not _without_a_cut(scored, tests):
        return False
    return not any(acts and test.kind == _CUTTING for test, acts in zip(tests, scored.acts, strict=True))


def _without_a_cut(scored: Scored, tests: Sequence[TestData]) -> list[str]:
    """The tests in which it acts though by their kind nothing is cut: 'speed (spectrum)'; none of another cause."""
    if scored.candidate.family != _CUTTING or not len(scored.rows):  # what was not scored acts nowhere
        return []
    acting = (test for test, acts in zip(tests, scored.acts, strict=True) if acts and test.kind in _NOTHING_IS_CUT)
    return list(dict.fromkeys(f"{test.test} ({test.kind.replace('_', ' ')})" for test in acting))


def also_of_motor(scored: Scored, claims: Sequence[Scored]) -> str:
    """What drives a motor heats it before it cuts: said of a power that is not surely a cause of its own, beside a
    sharper claim of the motor's temperature; else ''."""
    if probability(scored) >= SURE or not any(n.quantity in _DRIVES_A_MOTOR for n in scored.candidate.effect.needs):
        return ""
    motors = [c for c in claims if _reads_motor(c) and sharpness(c) > sharpness(scored)]
    if not motors:
        return ""
    heats = "heats" if len(scored.candidate.channels) == 1 else "heat"
    return (
        f"; {listed(scored.candidate.channels)} {heats} the motor too, which is claimed as {motors[0].candidate.id}: "
        "it may be more of that heat and no cause of its own, which the same path as an air cut tells: add that one "
        "first, and ask again"
    )


def _reads_motor(scored: Scored) -> bool:
    return any(p.endswith("spindle.motor") for n in scored.candidate.effect.needs for p in n.places)
