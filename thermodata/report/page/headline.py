"""The first words of a report: what is missing, or was, what else it could be, how sure that is, and one error."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.report.collected.data import ReportData
from thermodata.report.collected.lost import lost_sentence
from thermodata.report.page.error_rows import ErrorRow, added_claims, error_rows, headline_error
from thermodata.report.text.clauses import clauses
from thermodata.report.text.confirmed import confirmed_sentence
from thermodata.report.verdict.candidate_errors import from_fitted
from thermodata.report.verdict.few_tests import few_tests
from thermodata.report.verdict.not_determined import not_determined
from thermodata.report.verdict.verdict import causes, claims_of, verdict_sentence
from thermodata.report.words.numbers import change, in_unit, number
from thermodata.report.words.of_response import of_response
from thermodata.schema.agreed.begins_on import IF_SO
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.confirmed import Confirmed
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.words.sentences import listed

_MOST_NAMED, _LONG = 2, 150  # claims, and letters: with names, twins and probabilities these fill five lines


def headline(data: ReportData) -> str:
    """The page's first sentence: the cause with what it can't be told from, and how sure; or the verdict."""
    claims, responses = added_claims(data), ", ".join(data.responses)
    if data.added:
        if claims:
            response = data.reason.response if data.reason else responses
            if _one_by_one(claims):
                return f"Missing in {response} were {len(claims)} effects"
            return f"Missing in {response} was {causes(claims)}"
        if data.offered:
            return (
                f"{data.added} was added to {data.name}: a refinement that its diagnosis offered, claimed as no cause"
            )
        if data.by_choice and all(asked.holds for asked in data.by_choice):
            return f"{data.added} was added to {data.name} by choice, and holds on the locked tests"
        return f"{data.added} was added to {data.name}, and no diagnosis claims it"
    if data.diagnosis:
        claims = claims_of(data.diagnosis)
        if claims:
            what = f"{len(claims)} effects" if _one_by_one(claims) else causes(claims)
            return f"{data.diagnosis.response} misses {what}"
        return capital(clauses(_verdict(data, data.diagnosis))[0])
    return f"{data.name} models {responses}; thermodata diagnose {data.name} says what it misses"


def claim_lines(data: ReportData) -> list[str]:
    """A line for each claim that the headline only counts; none where it names them."""
    told = added_claims(data) if data.added else claims_of(data.diagnosis) if data.diagnosis else []
    return [causes([claim]) for claim in told] if _one_by_one(told) else []


def _one_by_one(claims: Sequence[Candidate]) -> bool:
    """Whether each has a line below the headline, which counts them."""
    return len(claims) > _MOST_NAMED or (len(claims) > 1 and len(causes(claims)) > _LONG)


def error_sentence(data: ReportData) -> str:
    """The one error of the head, by its word; '' where nothing was scored."""
    row = headline_error(error_rows(data))
    if row is None:
        return ""
    of = f" of {row.of}" if row.of else ""
    what = f"The error{of} on {tests_of(row)}"
    if row.before is None:
        return f"{what} is {number(row.after)} {row.unit}"
    verb = "falls" if row.after < (row.compared or row.before) else "does not fall"
    changed = change(row.compared, row.after)
    if row.refitted is None:
        return f"{what} {verb}: {number(row.before)} -> {number(row.after)} {row.unit} ({changed})"
    figures = from_fitted(row.before, row.refitted, row.after).removesuffix(" um")
    return f"{what} {verb}: {figures} {row.unit} ({changed} from {number(row.refitted)})"


def _foretold(data: ReportData) -> str:
    """The errors that a diagnosis foretold of what was added, where second lags came along."""
    rows = [r for r in error_rows(data) if r.foretold and r.before is not None]
    each = [f"on {tests_of(r)} {number(r.compared)} -> {number(r.after)} {r.unit}" for r in rows]
    return f"{capital(rows[0].foretold)}; the error {listed(each)}" if rows else ""


def tests_of(row: ErrorRow) -> str:
    """'locked tests', 'the tests that were fitted'."""
    if row.word == "fitted":
        return "the tests that were fitted"
    if row.word == "left-out":
        return row.left_out
    return f"{row.word} tests{'' if row.tested or row.foretold else ', which are fitted too by now,'}"


def first_sentences(data: ReportData) -> list[str]:
    """Of what stands below, what a reader acts by: each claim, the one error, what the confirmation of a choice says
    against it, the verdict of now, and what its tests can't say."""
    said = [*claim_lines(data), _error_unless_told(data)]
    said += [_by_choice(asked) for asked in data.by_choice if not asked.holds]
    found = data.diagnosis
    if found is not None:
        first, *further = clauses(_verdict(data, found))
        if data.added:
            said.append(f"Now: {first}")
        elif not claims_of(found):
            said += map(capital, further[:1])
        unsure = [few_tests(found), *not_determined(found)[:1]]
        said += [capital(in_unit(line, data.unit_of(found))) for line in unsure]
    return list(dict.fromkeys(_ended(said)))


def sentences(data: ReportData) -> list[str]:
    """All that stands below: the error, the evidence of what was added, and the verdict of now."""
    lines = [_error_unless_told(data), *_levels(data), _foretold(data)]
    lines += map(_by_choice, data.by_choice)
    lines.append(capital(lost_sentence(data.before, data.scores, data.checks)))
    claims = added_claims(data)
    lines[:0] = claim_lines(data)
    if claims and data.reason and not data.diagnosis:
        lines.append(capital(of_response(data.reason)))
    for claim in claims:
        # ids stay as they are typed
        why = f"{claim.id}: {claim.why}" if len(claims) > 1 else capital(claim.why)
        lines.append(why)
    for claim in claims or (claims_of(data.diagnosis) if data.diagnosis and not data.added else []):
        if claim.equivalent:
            lines.append(f"These tests can't tell {claim.id} from {listed(claim.equivalent)}")
    # errors of one response stand behind its name
    of = capital(of_response(data.diagnosis)) if data.diagnosis else ""
    if data.diagnosis and (data.added or claims_of(data.diagnosis)):
        first, *further = clauses(_verdict(data, data.diagnosis))
        # else the headline has its first words
        lines += [of, f"Now: {first}" if data.added else "", *map(capital, further)]
    elif data.diagnosis:
        # its first words are the headline
        lines[:0] = [of, *map(capital, clauses(_verdict(data, data.diagnosis))[1:])]
    return _ended(lines)


def _ended(lines: Sequence[str]) -> list[str]:
    """With a full stop each; without what is empty."""
    return [line if line.endswith(".") else f"{line}." for line in lines if line]


def _error_unless_told(data: ReportData) -> str:
    """The one error; '' where the verdict that nothing is missing has that figure already."""
    row = headline_error(error_rows(data))
    return "" if row is not None and number(row.after) in headline(data) else error_sentence(data)


def _by_choice(asked: Confirmed) -> str:
    return f"Asked by choice, {confirmed_sentence(asked)}"


def _levels(data: ReportData) -> list[str]:
    """What scores and weak spots show, and errors on left-out tests do not: tests that begin with something on."""
    # the verdict that nothing is missing tells them
    said = data.diagnosis is not None and data.diagnosis.verdict == "none" and bool(data.diagnosis.started_on)
    off = [c for c in data.checks if c.name.startswith("on_at_start:") and not c.passed and not said]
    left_out = any(row.word == "left-out" for row in error_rows(data))
    hidden = "; errors on left-out tests have their level free and do not show it" if left_out else ""
    return [c.advice.partition(IF_SO)[0] + hidden for c in off]


def _verdict(data: ReportData, found: Diagnosis) -> str:
    return in_unit(verdict_sentence(found), data.unit_of(found))


def capital(text: str) -> str:
    """With a capital, but for what is typed so: a command, or a name with an underscore or a bracket next to it."""
    first, _, rest = text.partition(" ")
    typed = first == "thermodata" or "_" in first or rest.startswith("(")
    return text if typed else text[:1].upper() + text[1:]
