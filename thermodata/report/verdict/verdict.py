"""A verdict in words, the same in the terminal and on the page: every claim and every refinement that it holds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from thermodata.report.verdict.candidate_errors import left_out_errors, locked_errors
from thermodata.report.verdict.could_hide import could_be, was_not_asked
from thermodata.report.verdict.few_tests import few_tests
from thermodata.report.verdict.left_over import (
    as_of_nothing,
    left_over,
    most_left,
    not_logged,
    offered,
    on_left_out,
    stays,
)
from thermodata.report.verdict.not_determined import not_determined
from thermodata.report.verdict.refined import can_be_refined, explained_by_refining, named, told_with_errors
from thermodata.report.verdict.stopped import asks_locked, better_with, is_likely, stopped
from thermodata.report.verdict.twins import by_name, not_told_from
from thermodata.report.verdict.unasked import unasked
from thermodata.report.words.numbers import duration, number, percent
from thermodata.schema.agreed.limits import CLAIMS_ASK, PLAUSIBLE
from thermodata.schema.answers.clocks_in_doubt import clocks_in_doubt
from thermodata.schema.answers.slip_ids import slip_ids, slips_of
from thermodata.schema.words.places import heat_at
from thermodata.schema.words.sentences import apart, in_percent, listed, with_count

if TYPE_CHECKING:
    from thermodata.schema.answers.candidate import Candidate
    from thermodata.schema.answers.diagnosis import Diagnosis, PutRight

NOT_EXCLUDED = 0.1
"""A cause of this probability is named though none is said to be missing."""
_NO_CHANCE, _MUCH = 0.01, 0.3  # a p-value, and a share of the squared error, with which a candidate is seen
_MOST_STEPS = 3
UNLIKELY = 0.05
"""A cause of less than this probability is none that somebody should look for."""
AS_DATED = " as the logs are dated"
NO_MORE = "the open tests show no missing cause that the model has nothing of"
FAR_LESS = 0.7
"""What leaves this share of the error of what is claimed is told beside it: why it is not the one."""
FAR = 2.0
"""An error on locked tests of so many times that on left-out ones says that these lack something."""
_LIKELY, _MORE = 0.5, 0.05  # that it is one of two parts is told where it is likely, and says more than of the one


def probability(share: float | None) -> str:
    """'94 %', and never certain: 'over 99 %'; '' where none is stated. What is less than a claim asks never looks like
    that: '64.5 %'."""
    if share is None:
        return ""
    under = next((limit for limit in CLAIMS_ASK if share < limit and in_percent(share) == in_percent(limit)), None)
    if under is not None:
        return apart(share, under)
    return "under 1 %" if share < 0.01 else percent(share)


def claims_of(found: Diagnosis) -> list[Candidate]:
    """The missing causes that are claimed, the first one first."""
    return [c for c in found.candidates if c.claimed]


def refinements_of(found: Diagnosis) -> list[Candidate]:
    """What would refine effects that the model has."""
    return [c for c in found.candidates if c.refinement]


def told(found: Diagnosis) -> list[Candidate]:
    """The candidates whose evidence is told in full: all claims, else the first of the others; and all refinements.
    What the verdict names comes first, and last the one that would leave far less than what is claimed."""
    claims, refined = claims_of(found), refinements_of(found)
    causes = claims or [c for c in found.candidates if not c.refinement][:1]
    named = [*refined, *causes] if found.verdict == "refine" else [*causes, *refined]
    return [*named, *_leaves_far_less(found, claims)]


def _leaves_far_less(found: Diagnosis, claims: Sequence[Candidate]) -> list[Candidate]:
    """Whoever reads the table would add it instead: of what no claim is said to be, the one of the least error."""
    if not claims:
        return []
    least = min((c.rmse_um_after for c in claims if c.rmse_um_after is not None), default=0.0)
    known = {name for c in (*claims, *refinements_of(found)) for name in (c.id, *c.equivalent)}
    others = [c for c in found.candidates if c.rmse_um_after is not None and c.id not in known]
    first = min(others, key=lambda c: c.rmse_um_after or 0.0, default=None)
    return [first] if first is not None and (first.rmse_um_after or 0.0) < FAR_LESS * least else []


def other_heat(one: Candidate) -> str:
    """'heat at axis.z.guide', which may be it as well; '' where its channels tell it from all else."""
    return heat_at(one.unread, " or ")


def verdict_sentence(found: Diagnosis) -> str:
    """The verdict in one sentence with its figures: every claim, every refinement, what is wanting where few tests are
    open, which effects of the model they do not determine, what of the logs was put right before, which clocks are in
    doubt, and which tests the model was made without."""
    parts = [
        _verdict(found),
        few_tests(found),
        *not_determined(found),
        put_right(found.put_right),
        without_steps(found),
    ]
    return "; ".join(filter(None, [*parts, *found.doubtful_clocks, *_made_without(found)]))


def _made_without(found: Diagnosis) -> list[str]:
    """'this version was made without V03: its probe is turned, mend it ...': nothing else tells of a test that no
    answer sees any more."""
    return [f"this version was {note.replace('; ', ', ')}" for note in found.made_without]


def without_steps(found: Diagnosis) -> str:
    """'errors on left-out tests are without the step in V04 at 2.2 h (+14.0 um), ...': of what was taken out of these
    alone; '' where nothing was."""
    steps = slips_of(found)
    if not steps or found.rmse_um is None:
        return ""
    sizes = [f"{'+' if (a.size_um or 0.0) > 0 else ''}{number(a.size_um)} um" for a in steps]
    named = [f"in {a.test} at {duration(a.at_s)} ({size})" for a, size in zip(steps, sizes, strict=True)]
    s, it = ("s", "them") if len(steps) > 1 else ("", "it")
    return (
        f"errors on left-out tests are without the step{s} {with_count(named, _MOST_STEPS)}, but fits, parameters "
        f"and errors on locked tests have {it}, until the model is without (thermodata add {found.model[:8]} "
        f"{' '.join(slip_ids(found))})"
    )


def put_right(found: PutRight | None) -> str:
    """'judged without day2, where the probe is turned round, and with the clock of nc moved by +61 min'; '' where the
    logs were taken as they are."""
    if found is None:
        return ""
    tests = [test for _, test in found.left_out]
    clocks = [
        f"of {c.source} moved by {c.moved_s / 60:+.0f} min{f' in {c.test}' if c.test else ''}" for c in found.clocks
    ]
    parts = [f"without {listed(tests)}, where the probe is turned round,"] if tests else []
    parts += [f"with the clock{'s' if len(clocks) > 1 else ''} {listed(clocks)}"] if clocks else []
    return f"judged {listed(parts).removesuffix(',')}"


def _verdict(found: Diagnosis) -> str:
    claims, refined = claims_of(found), refinements_of(found)
    if found.verdict == "effect" and claims:
        return "; ".join(filter(None, [_missing(claims, found), unasked(found), can_be_refined(found)]))
    if found.verdict == "unknown":
        refined_by = told_with_errors(found, ": add {them} and ask again")
        return "; ".join(filter(None, [_unclaimed(found), not_logged(found), unasked(found), refined_by]))
    # left-out tests have their level free
    far = _far_on_locked(found, found.locked_rmse_um if found.locked_shape_um is None else found.locked_shape_um)
    there = f"but an earlier claim left the locked tests with {far}, and these may lack one" if far else ""
    open_still = "; ".join(filter(None, [there, _not_excluded(found)]))
    doubt = clock_in_doubt(found)
    as_dated = AS_DATED if doubt else ""
    if found.verdict == "refine" and refined and not any(c.as_modelled for c in refined):
        return "; ".join(
            filter(
                None, [doubt, f"{NO_MORE}{as_dated}", told_with_errors(found), stays(found), open_still, unasked(found)]
            )
        )
    if found.verdict == "none" or any(c.as_modelled for c in refined):
        named = " that may be named" if is_likely(_not_excluded_one(found)) or _one_is_seen(found) else ""
        mend = offered(found)
        beside = "where its effects may act otherwise, " if mend else ""
        none = f"{beside}the open tests show no missing effect{named}{as_dated}: {left_over(found)}{most_left(found)}"
        return "; ".join(filter(None, [doubt, mend, none, open_still]))
    return {
        "effect": "missing: an effect that the data point to",
        "refine": f"{NO_MORE}, but an effect that is there acts otherwise than modelled",
        "not_testable": "these tests can't tell which effect is missing",
    }[found.verdict]


def _one_is_seen(found: Diagnosis) -> bool:
    """Whether the list begins with what is no chance and takes much of the error away."""
    first = next((c for c in found.candidates if not c.refinement), None)
    if first is None or first.p_value is None or first.rmse_um_after is None or not first.rmse_um_before:
        return False
    return first.p_value <= _NO_CHANCE and 1 - (first.rmse_um_after / first.rmse_um_before) ** 2 >= _MUCH


def clock_in_doubt(found: Diagnosis) -> str:
    """'a clock may be off in feed20, ...': a hint that the answer did not act upon, told before all that hangs on it;
    '' where there is none."""
    tests = clocks_in_doubt(found.artefacts, found.put_right)
    if not tests:
        return ""
    return (
        f"a clock may be off in {listed(tests)}, by which nothing was moved: first try what the artefact says, for "
        "until then something may be missing"
    )


def _not_excluded_one(found: Diagnosis) -> Candidate | None:
    """The likeliest cause where none is said to be missing, if it is one in so many cases, and by another channel than
    what is refined, or as probable as a claim asks."""
    first = next((c for c in found.candidates if not c.refinement and not c.gain_by and not c.phases), None)
    if first is None or (first.probability or 0.0) < NOT_EXCLUDED:
        return None
    of_refined = any(set(first.drivers) <= set(c.drivers) for c in refinements_of(found))
    return None if of_refined and not is_likely(first) else first


def _not_excluded(found: Diagnosis) -> str:
    """With what stops it, where it is as probable as a claim asks."""
    first = _not_excluded_one(found)
    if first is None:
        return ""
    likely = is_likely(first)
    said = f"not excluded: {_with_probability(first)}{stopped(first) if likely else ''}"
    return "; ".join(filter(None, [said, asks_locked(first, found) if likely else ""]))


def _missing(claims: Sequence[Candidate], found: Diagnosis) -> str:
    errors = left_out_errors(claims, found.rmse_um, found.named_rmse_um)
    return f"missing: {causes(claims)}; {errors}{locked_errors(claims)}"


def causes(claims: Sequence[Candidate]) -> str:
    """'screw (T_nut), not told from motor (T_mot), probability 94 % (that it is one of these)', the same
    wherever a claim is told."""
    names = [_with_probability(c) for c in claims]
    # commas stand within a name and its probability
    return names[0] if len(names) == 1 else ", and ".join([", ".join(names[:-1]), names[-1]])


def _with_probability(one: Candidate) -> str:
    """A twin that is named beside it counts as right in what is known of such probabilities."""
    twins = not_told_from(one)
    of = " (that it is one of these)" if twins else ""
    plain = f"probability {probability(one.probability or 0.0)}"
    told = plain if twins or one.claimed else _how_likely(one)
    sure = "" if one.probability is None else f"{told}{of}"
    return ", ".join(filter(None, [_or_elsewhere(one), twins, sure]))


def _or_elsewhere(one: Candidate) -> str:
    told = named(one) + by_name(one)
    return f"{told} or {other_heat(one)}, which {listed(one.drivers)} can't tell from it" if one.unread else told


def _unclaimed(found: Diagnosis) -> str:
    """What is missing has no name; the likeliest candidate is told with it, for it stands below."""
    some = [c for c in found.candidates if c.probability is not None and not c.refinement]
    first = max(some, key=lambda c: c.probability or 0.0, default=None)
    far, share = _far_on_locked(found, found.locked_rmse_um), 0.0 if first is None else first.probability or 0.0
    far += " from their first samples on" if far and found.locked_shape_um is not None else ""
    seen = f" on the locked tests, which an earlier claim left with {far}" if far else ""
    # no more than models leave of a machine that lacks nothing, and nothing is plausible: then nobody knows
    as_much = "" if far or share >= PLAUSIBLE else as_of_nothing(found)
    if first is not None and share < UNLIKELY:
        unasked = was_not_asked(found)
        nothing = "nothing that was asked for" if unasked else "nothing logged"
        left = f"something is left{f'{seen},' if seen else on_left_out(found)} that {nothing} is likely to explain"
        left += explained_by_refining(found)
        left += f", though {as_much}" if as_much else ""
        nearest = f"{_or_elsewhere(first)} comes nearest, probability {probability(share)}"
        open_still = could_be(found)
        if open_still:
            nearest += f"; it may still be {open_still}, which they can't exclude"
            left += ", as far as these tests can tell"
        return "; ".join(filter(None, [f"{left}: {nearest}", unasked]))
    missing = f"something may be missing, though {as_much}; " if as_much else f"something is missing{seen}, and "
    if first is None:
        return f"{missing}nothing logged may be named for it"
    asked = ", with that of the locked tests," if first.locked_tests_asked else ""
    likeliest = f"the likeliest that was logged is {_or_elsewhere(first)}, {_how_likely(first)}"
    none = f"{missing}the evidence{asked} does not suffice to name a cause; {likeliest}{stopped(first)}"
    return "; ".join(filter(None, [none, asks_locked(first, found), better_with(found, first)]))


def _how_likely(one: Candidate) -> str:
    """'probability 18 %', or where another part may be it 'probability 18 % (84 % that it is one of these)': to be
    unsure of the part is not to be unsure of the heat that both share."""
    own, either = one.probability or 0.0, one.probability_with_unread
    sure = f"probability {probability(own)}"
    if not one.unread or either is None or either < _LIKELY or either - own < _MORE:
        return sure
    return f"{sure} ({probability(either)} that it is one of these)"


def _far_on_locked(found: Diagnosis, locked: float | None) -> str:
    """'3.32 um', which an earlier claim left on the locked tests; '' where it is near to that on left-out ones."""
    left = found.rmse_um
    far = locked is not None and left is not None and locked >= FAR * left
    return f"{number(locked)} um" if far and locked is not None else ""
