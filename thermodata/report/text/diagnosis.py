"""A verdict and a confirmation as text for a person: in the terminal and in a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.text.candidates import candidates_text
from thermodata.report.text.clauses import clauses, in_lines
from thermodata.report.text.fit import spots_text
from thermodata.report.text.parameters import parameters_text
from thermodata.report.text.table import table
from thermodata.report.verdict.candidate_errors import from_fitted, left_out_tests
from thermodata.report.verdict.could_hide import could_hide
from thermodata.report.verdict.left_over import in_parts, noise_words
from thermodata.report.verdict.log_faults import log_faults
from thermodata.report.verdict.refined import to_add
from thermodata.report.verdict.verdict import explainable, probability, put_right, told, verdict_sentence
from thermodata.report.words.glossary import PARTS, explained
from thermodata.report.words.numbers import duration, heat_lines, number
from thermodata.report.words.of_response import of_response
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thermodata.schema.answers.candidate import Candidate
    from thermodata.schema.answers.confirmed import Confirmed
    from thermodata.schema.answers.diagnosis import Diagnosis


def confirmed_text(result: Confirmed) -> str:
    """A confirmation for a person."""
    told = [_confirmed_sentence(result), _other_way(result), _rises_in(result), _one_lag(result)]
    told.append(put_right(result.put_right))
    head = "; ".join(filter(None, told))
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
    return f"{head}{said}\n\n{table(rows, columns)}\n\nthe locked tests have been opened {times(result.looks)} so far"


def _other_way(result: Confirmed) -> str:
    """That the model as it is fitted says otherwise than its refit, which a choice is judged beside; '' else."""
    before, after, fitted = result.locked_rmse_um_before, result.locked_rmse_um_after, result.locked_rmse_um_fitted
    if before is None or after is None or fitted is None or (after < fitted) == (after < before):
        return ""
    return (
        "that is beside the refitted model, which has all of these but the effect; the model as it is fitted leaves "
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
    said = "holds" if result.holds else "holds in shape only" if in_shape_only else "does not hold"
    head = f"{result.candidate} {said} on the locked tests"
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


def _asked(found: Diagnosis) -> str:
    said = of_response(found)
    return f"{said}; --response asks of another" if said else ""


def _claims(found: Diagnosis) -> list[str]:
    """What each claimed effect is like, and the command that takes it in, and that which takes all in; where what the
    model has is refined, the command that does."""
    claims = [c for c in found.candidates if c.claimed]
    if found.verdict == "refine" and not any(c.as_modelled for c in found.candidates):
        return [f"to have {listed([c.id for c in some])}: {_add(found.model, some)}" for some in to_add(found)]
    each = [_claim(found.model, c) for c in claims]
    if len(claims) < 2:
        return each
    return [*each, f"to have {'both' if len(claims) == 2 else 'all'}: {_add(found.model, claims)}"]


def _claim(model: str, c: Candidate) -> str:
    values = parameters_text(c)
    return (f"{c.id}: {values}\n" if values else "") + f"to have it: {_add(model, [c])}"


def _add(model: str, some: Sequence[Candidate]) -> str:
    return f"thermodata add {model} {' '.join(str(c.rank) for c in some)}"


def _on_locked(found: Diagnosis) -> str:
    """With a free level first, as left-out tests have it."""
    if found.locked_rmse_um is None:
        return _opened_for(found)
    scored = f"{number(found.locked_rmse_um)} um"
    if found.locked_shape_um is None:
        return f"on locked tests {scored}"
    return f"on locked tests {number(found.locked_shape_um)} um about each one's mean, {scored} from first samples on"


def _opened_for(found: Diagnosis) -> str:
    """That no locked test was opened, or that there is none, for silence would count as evidence; or for which mode of
    the model's effects, for each look is counted. '' where a claim or its reason says so."""
    asked = [c for c in found.candidates if c.claimed or c.locked_tests_asked]
    if not asked:
        none = "no test is locked" if found.locked_tests == 0 else "no locked test was opened for this answer"
        return "" if found.verdict == "not_testable" else none
    modes = [c for c in asked if c.refinement and c.locked_shape_um_before is not None]
    if len(modes) < len(asked):
        return ""
    each = [f"{c.id} {number(c.locked_shape_um_before)} -> {number(c.locked_shape_um_after)} um" for c in modes]
    return f"on locked tests, opened for it, about each one's mean: {', '.join(each)}"


def diagnosis_text(found: Diagnosis, top: int = 8) -> str:
    """A diagnosis for a person: the verdict, a clause a line, its figures, and what they rest on."""
    on = left_out_tests(found.candidates)
    of = "as it is fitted the model leaves" if found.verdict == "not_testable" else f"error on {on}"
    left = "" if found.rmse_um is None else f"{of} {number(found.rmse_um)} um"
    errors = ", ".join(filter(None, [left, _on_locked(found)]))
    figures = filter(None, [errors, noise_words(found), explainable(found)])
    verdict, *further = clauses(verdict_sentence(found))
    parts = ["\n  ".join(filter(None, [verdict, _asked(found), *further])), "\n".join(figures)]
    if found.candidates:
        parts.append(candidates_text(_in_table(found, top), found.rmse_um))
        parts += _claims(found)
        parts += [in_lines(f"why {c.id}: {c.why}") for c in told(found) if c.why]
    if found.weak_spots:
        parts.append(spots_text(found.weak_spots, most=top))
    if found.artefacts:
        parts.append(
            "artefacts\n"
            + "\n".join(
                f"  ! {a.kind} in {', '.join(a.places)}"
                + ("" if a.at_s is None else f" at {duration(a.at_s)}")
                + ("" if a.step_um is None else f": {number(a.step_um)} um")
                + f". {a.why}"
                for a in log_faults(found.artefacts)
            )
        )
    if found.not_asked:
        parts.append(
            "left out, for their plugins fail\n" + "\n".join(f"  ! {one.effect}: {one.why}" for one in found.not_asked)
        )
    if found.unknown:
        hints = found.unknown.model_dump()
        parts.append(
            "what is left behaves like\n"
            + "\n".join(
                f"  {name}: {between.join(number(v) if isinstance(v, float) else str(v) for v in hints[key])}"
                for name, key, between in (
                    ("memory (its autocorrelation falls to 1/e) [h]", "time_constants_h", ", "),
                    ("hours of the day (UTC) at which the residual stands out", "hours_of_day", ", "),
                    ("states", "states", "; "),  # commas stand within one
                )
                if hints[key]
            )
        )
    if found.unknown and found.unknown.heat:
        heat = found.unknown.heat
        parts.append(
            f"the missing heat, estimated\n  {heat.where}\n"
            + "\n".join(f"  {what}: {text}" for what, text in heat_lines(heat))
        )
    if hides := could_hide(found):
        parts.append(in_lines(hides))
    if found.next_test:
        parts.append(in_lines(f"next test: {found.next_test}"))
    parts.append(_words(found))
    return "\n\n".join(parts)


def _words(found: Diagnosis) -> str:
    """What the words for its errors mean."""
    if found.verdict == "not_testable":
        return explained("fitted")
    words = explained("left-out", *(["locked"] if any(c.locked_tests_asked for c in found.candidates) else []))
    left_out, *others = words.splitlines()
    told_of_parts = in_parts(found)
    return "\n".join([f"left-out: {PARTS}; {told_of_parts}" if told_of_parts else left_out, *others])


def _in_table(found: Diagnosis, top: int) -> list[Candidate]:
    """The first `top`, and below them what is told of all the same: nobody has to look for the row of a sentence."""
    named = {c.rank for c in told(found)}
    return [c for c in found.candidates if c.rank <= top or c.rank in named]
