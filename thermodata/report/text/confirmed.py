"""A confirmation as text for a person: in the terminal, in a notebook and on a page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.text.table import table
from thermodata.report.verdict.candidate_errors import ONCE_FITTED, from_fitted
from thermodata.report.verdict.verdict import probability, put_right
from thermodata.report.words.numbers import number

if TYPE_CHECKING:
    from thermodata.schema.answers.confirmed import Confirmed


def confirmed_sentence(result: Confirmed) -> str:
    """What the locked tests say of the choice, in one sentence."""
    told = [_confirmed_sentence(result), _other_way(result), _rises_in(result), _one_lag(result)]
    told.append(put_right(result.put_right))
    return "; ".join(filter(None, told))


def held_in_words(result: Confirmed) -> str:
    """'holds', 'holds in shape only', 'does not hold', 'hardly acts there'."""
    if result.holds is None:
        return "hardly acts there"
    in_shape_only = not result.holds and result.holds_by_shape is True
    return "holds" if result.holds else "holds in shape only" if in_shape_only else "does not hold"


def confirmed_text(result: Confirmed) -> str:
    """A confirmation for a person, and what to type next where it holds."""
    head = confirmed_sentence(result)
    if result.despite and result.probability is not None:
        claims, colon, why = result.despite.partition(":")
        head += f". {claims[0].upper()}{claims[1:]}, with {probability(result.probability)}{colon}{why}"
    rows, refitted = [t.model_dump() for t in result.tests], result.locked_rmse_um_fitted is not None
    columns = [
        ("campaign", "campaign"),
        ("test", "test"),
        *([("rmse_um_fitted", "as fitted [um]")] if refitted else []),
        ("rmse_um_before", "refitted [um]" if refitted else "before [um]"),
        ("rmse_um_after", "after [um]"),
    ]
    said = f"\n{result.note}" if result.note else ""
    opened = f"the locked tests have been opened {times(result.looks)} so far"
    onward = f"to have it: thermodata add {result.model[:8]} {result.candidate}"
    onward = f"\n{onward}" if result.holds and not result.note else ""
    return f"{head}{said}\n\n{table(rows, columns)}\n\n{opened}{onward}"


def _other_way(result: Confirmed) -> str:
    """That the model as it is fitted says otherwise than its refit, which a choice is judged beside; '' else."""
    before, after, fitted = result.locked_rmse_um_before, result.locked_rmse_um_after, result.locked_rmse_um_fitted
    if before is None or after is None or fitted is None or (after < fitted) == (after < before):
        return ""
    return (
        f"before is what it leaves {ONCE_FITTED}; the model as it is fitted leaves "
        f"{'more' if after < fitted else 'less'} there, as scored, than with it"
    )


def _rises_in(result: Confirmed) -> str:
    """'yet the error rises in tool2/mix2, 7.69 -> 11.6 um': a test against what holds over all; '' where none is."""
    if not result.holds:
        return ""
    several = len({t.campaign for t in result.tests}) > 1
    rising = [
        f"{f'{t.campaign}/' if several else ''}{t.test}, "
        + from_fitted(t.rmse_um_fitted, t.rmse_um_before, t.rmse_um_after)
        for t in result.tests
        if t.acts and t.rmse_um_after > _RISES * t.rmse_um_before
    ]
    return f"yet from its first samples on the error rises in {' and in '.join(rising)}" if rising else ""


_RISES = 1.02  # less is no rise, as of all tests together (thermodata/diagnosis/locked/held.py)
_AS_SCORED = "as tests are scored, from their first samples on,"
_START = "the course fits and where it starts does not (a test that began warm, or noise where its zero is taken)"


def _confirmed_sentence(result: Confirmed) -> str:
    """By its shape, with a free offset a test, and as scored; where these say otherwise both are told."""
    before, after = result.locked_rmse_um_before, result.locked_rmse_um_after
    scored = "" if before is None or after is None else from_fitted(result.locked_rmse_um_fitted, before, after)
    if result.holds is None:
        if clear := _clear_though_small(result, scored):
            return clear
        return (
            f"{result.candidate} hardly acts in the locked tests (under a fifth of its largest), so these say little "
            "of it" + (f" ({scored})" if scored else "") + ": one that moves it more would, locked, from a cold start"
        )
    in_shape_only = result.holds is False and result.holds_by_shape is True
    head = f"{result.candidate} {held_in_words(result)} on the locked tests"
    if before is None or after is None:
        return head
    shape = ""
    if result.holds is False and not in_shape_only:
        return _not_held(result, head, scored)
    if result.locked_shape_um_before is not None:
        figures = f"{number(result.locked_shape_um_before)} -> {number(result.locked_shape_um_after)} um"
        shape = f"{figures} about each test's mean"
    if shape and not all(t.acts for t in result.tests):
        where = ", ".join(t.test for t in result.tests if t.acts)
        rises = ""
        if in_shape_only:
            rises = f", and it rises where it acts: {_START}"
        elif result.holds and after > before:
            rises = ", where it rises in those in which it acts least"
        return (
            f"{head} in which it acts most ({where}): {shape}; from their first samples on, over all, {scored}{rises}"
        )
    if in_shape_only:
        return f"{head}: {shape}, but from their first samples on the error rises, {scored}: {_START}"
    if result.holds == (after < before) or not shape:
        return f"{head}: {scored}"
    return f"{head} by its shape, {shape}; from their first samples on it hardly changes, {scored}"


def _clear_though_small(result: Confirmed, scored: str) -> str:
    """Of what does under a fifth of its largest in the locked tests, where their error falls clearly all the same: to
    call that little would contradict the errors below. '' where it does not."""
    before, after = result.locked_rmse_um_before, result.locked_rmse_um_after
    does = max((t.does_um or 0.0 for t in result.tests), default=0.0)
    if result.most_um is None or before is None or after is None or after > _CLEARLY * before:
        return ""
    return (
        f"{result.candidate} does {number(does)} um about the mean of the locked test in which it does most, under a "
        f"fifth of its largest ({number(result.most_um)} um), so that these are not asked whether it holds. Their "
        f"error falls all the same, {scored}: by what it does there, and by what the effects of the model do "
        "otherwise beside it. A locked test that moves it more would bear it out"
    )


_CLEARLY = 0.7  # of the error: half of its square is gone


def _one_lag(result: Confirmed) -> str:
    """Of what does not hold: `add` may do more than what was asked here; '' of what has no lag."""
    if result.holds is not False or not any(name.endswith(".tau") for name in result.parameters):
        return ""
    return (
        "it was asked with one lag, beside the effects as the model has them: add may give it, or one of these, a "
        "second one where left-out tests want that, and then says other errors"
    )


def _not_held(result: Confirmed, head: str, scored: str) -> str:
    """The reason first: a fall of the error as scored, which no verdict goes by, would else contradict it."""
    before, after = result.locked_shape_um_before, result.locked_shape_um_after
    acts = [t.test for t in result.tests if t.acts]
    head += f" in which it acts most ({', '.join(acts)})" if acts and len(acts) < len(result.tests) else ""
    if before is None or after is None:
        return f"{head}: {scored}"
    figures = f"{number(before)} -> {number(after)} um"
    if after >= before:
        reason = f"for its course does not fit: about each test's mean the error rises, {figures}"
        return f"{head}, {reason} ({_AS_SCORED} {scored})"
    reason = (
        f"{head}, for what it adds is not found there: about each test's mean the error goes {figures} only, where a "
        "cause of its size takes away twice as much and more, in squares"
    )
    if (result.locked_rmse_um_after or 0.0) < (result.locked_rmse_um_before or 0.0):
        return f"{reason}; that it goes {scored} {_AS_SCORED} counts where they start, too"
    return f"{reason} ({_AS_SCORED} {scored})"


def times(n: int) -> str:
    """'once', '3 times'."""
    return "once" if n == 1 else f"{n} times"
