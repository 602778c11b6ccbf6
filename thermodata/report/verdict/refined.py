"""What would refine the model, in words: what is worth adding, and what left-out or locked tests do not bear out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.verdict.candidate_errors import left_out_errors, left_out_tests
from thermodata.report.verdict.twins import named_twins
from thermodata.report.words.numbers import number
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thermodata.schema.answers.candidate import Candidate
    from thermodata.schema.answers.diagnosis import Diagnosis


MUCH = 0.3
"""Of the error on left-out tests: who takes so much off explains what is left, a cause of its own or not."""
HARDLY = 0.05
"""A fall of an error by less says nothing beside one where an effect acts."""


def worth_adding(one: Candidate) -> bool:
    """Whether left-out tests are foretold better with it, over all or where it acts; and locked ones no worse, where
    they were opened for it."""
    return not against_adding(one)


def against_adding(one: Candidate) -> str:
    """'left-out tests are foretold no better (1.00 -> 1.02 um)', of what is not worth adding; else ''."""
    return _rises_on_locked(one) or _rises_on_left_out(one) or ""


def can_be_refined(found: Diagnosis) -> str:
    """'what the model has can be refined by mode (T)', of what is worth adding; '' where nothing is."""
    worth = [c for c in found.candidates if c.refinement and worth_adding(c)]
    names = [named(c) + named_twins(c) for c in worth]
    # commas stand within what is told of a name
    told = ", and by ".join(names) if any(named_twins(c) for c in worth) else listed(names)
    return f"what the model has can be refined by {told}" if worth else ""


def explained_by_refining(found: Diagnosis) -> str:
    """' but screw (T_nut), which would refine what the model has', of what takes much off the error on left-out tests;
    '' where nothing does: without it, a head that names nothing stood above what halves the error."""
    before = found.rmse_um or 0.0
    worth = [c for c in found.candidates if c.refinement and worth_adding(c)]
    much = [c for c in worth if c.rmse_um_after is not None and c.rmse_um_after <= (1 - MUCH) * before]
    names = listed([named(c) for c in much], "or")
    return f" but {names}, which would refine what the model has" if much else ""


def to_add(found: Diagnosis) -> list[list[Candidate]]:
    """What to add at once to refine the model: all that is worth it, or one alone where left-out tests are foretold
    worse with all."""
    worth = [c for c in found.candidates if c.refinement and worth_adding(c)]
    return [[c] for c in worth] if _worse_together(found, worth) else [worth] if worth else []


def _worse_together(found: Diagnosis, worth: Sequence[Candidate]) -> bool:
    before, together = found.rmse_um, found.named_rmse_um
    return len(worth) > 1 and before is not None and together is not None and together > before


def told_with_errors(found: Diagnosis, advice: str = "") -> str:
    """The same with errors on left-out tests, and what is not worth adding with the errors that say so. advice: what
    to do with the former, '{them}' standing for it."""
    refined = [c for c in found.candidates if c.refinement]
    worth, others = ([c for c in refined if worth_adding(c) is is_worth] for is_worth in (True, False))
    parts = []
    if worth:
        them = "it" if len(worth) == 1 else "them"
        before, together = found.rmse_um, found.named_rmse_um
        if _worse_together(found, worth):
            rise = f"{number(before)} -> {number(together)} um"
            ask = f"{left_out_tests(worth)} are foretold worse with all of them ({rise})"
            parts.append(f"{can_be_refined(found)}, but {ask}: add one, and ask again")
        else:
            errors = _by_where_they_act(worth, before, together) or f", {left_out_errors(worth, before, together)}"
            parts.append(f"{can_be_refined(found)}{errors}{advice.format(them=them)}")
    return "; ".join([*parts, *map(_not_worth, others)])


def _by_where_they_act(worth: Sequence[Candidate], before: float | None, together: float | None) -> str:
    """': where it acts the error falls (1.33 -> 1.02 um), ...' of what hardly lets left-out tests fall over all, as it
    is offered for this and not for that; '' where they tell, and of answers of older versions."""
    if before is None or together is None or together <= (1 - HARDLY) * before:
        return ""
    falls = [(c, c.acting_um_before, c.acting_um_after) for c in worth]
    if any(b is None or a is None or a > (1 - HARDLY) * b for _, b, a in falls):
        return ""
    each = [(f"{c.effect} " if len(worth) > 1 else "") + f"{number(b)} -> {number(a)} um" for c, b, a in falls]
    acts, its = ("it acts", "its") if len(worth) == 1 else ("they act", "their")
    return (
        f": where {acts} the error falls ({', '.join(each)}), {its} size foretold by the other tests"
        f"{_and_on_locked(worth)}; all {left_out_tests(worth)} ({number(before)} -> {number(together)} um) do not "
        "tell, for there the effects of the model are foretold by the others, too"
    )


def _and_on_locked(worth: Sequence[Candidate]) -> str:
    """', and on locked tests, opened for it, 1.52 -> 1.17 um about each one's mean'."""
    locked = [(c, c.locked_shape_um_before, c.locked_shape_um_after) for c in worth]
    each = [
        (f"{c.effect} " if len(worth) > 1 else "") + f"{number(b)} -> {number(a)} um"
        for c, b, a in locked
        if b is not None and a is not None
    ]
    return f", and so it does on locked tests ({', '.join(each)} about each one's mean)" if each else ""


def _not_worth(one: Candidate) -> str:
    return (
        f"{named(one)} goes with what is left, but "
        f"{against_adding(one)} with it, so adding it is not advised"
        f"{_though_locked_fall(one)}"
    )


def _though_locked_fall(one: Candidate) -> str:
    """What speaks for it where locked tests were opened for it and left-out ones speak against it."""
    before, after = one.locked_shape_um_before, one.locked_shape_um_after
    if before is None or after is None or after >= before:
        return ""
    return f", though locked tests are foretold better ({number(before)} -> {number(after)} um about each one's mean)"


def _rises_on_left_out(one: Candidate) -> str | None:
    before, after = one.rmse_um_before, one.rmse_um_after
    falls = next((r.value for r in one.rungs if r.name == "fall"), None)
    if before is None or after is None or falls is None or falls > 0 or after <= (1 - HARDLY) * before:
        return None
    beside = f" beside {listed(one.beside)}" if one.beside else ""
    where = ""
    if after < before and one.acting_um_before is not None and one.acting_um_after is not None:
        where = f", where it acts {number(one.acting_um_before)} -> {number(one.acting_um_after)} um"
    better = "hardly" if after < before else "no"
    of = left_out_tests([one])
    return f"{of} are foretold {better} better ({number(before)} -> {number(after)} um{beside}{where})"


def _rises_on_locked(one: Candidate) -> str | None:
    before, after = one.locked_shape_um_before, one.locked_shape_um_after
    if before is None or after is None or after < before:
        return None
    return f"locked tests are foretold no better ({number(before)} -> {number(after)} um)"


def named(one: Candidate) -> str:
    """'feed_screw (T_nut_Z)', and how it acts otherwise than the model has it."""
    name = f"{one.effect} ({', '.join(one.drivers)})" if one.drivers else one.effect
    by_phase = f" with a function of its own in {listed(one.phases)}" if one.phases else ""
    return f"{name}{by_phase}{f' with a gain for each {one.gain_by}' if one.gain_by else ''}"
