"""A verdict as text for a person: in the terminal and in a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.text.candidates import candidates_text
from thermodata.report.text.clauses import clauses, in_lines
from thermodata.report.text.fit import spots_text
from thermodata.report.text.parameters import parameters_text
from thermodata.report.verdict.candidate_errors import left_out_tests
from thermodata.report.verdict.could_hide import could_hide
from thermodata.report.verdict.explainable import explainable
from thermodata.report.verdict.left_over import in_parts, noise_words
from thermodata.report.verdict.log_faults import log_faults
from thermodata.report.verdict.refined import to_add
from thermodata.report.verdict.verdict import told, verdict_sentence
from thermodata.report.words.glossary import PARTS, explained
from thermodata.report.words.numbers import duration, heat_lines, number
from thermodata.report.words.of_response import of_response
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thermodata.schema.answers.candidate import Candidate
    from thermodata.schema.answers.diagnosis import Diagnosis


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
