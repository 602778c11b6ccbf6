"""Renders ReportData as one HTML page that needs nothing beside it."""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.chart import effect_styles
from thermodata.report.charts.bars import waterfall
from thermodata.report.charts.figures import in_one_unit
from thermodata.report.charts.system import path_styles
from thermodata.report.collected.data import ReportData
from thermodata.report.collected.lost import lost_of_versions
from thermodata.report.page.drawn import chart_of, figures_of, heat_of, ranked_spots, response_of
from thermodata.report.page.error_rows import error_rows, headline_error
from thermodata.report.page.headline import capital, claim_lines, first_sentences, headline, sentences
from thermodata.report.page.left_over import what_is_left
from thermodata.report.page.rows_of_tests import score_rows, test_row
from thermodata.report.page.write import page_values, write_page
from thermodata.report.text.clauses import clauses
from thermodata.report.text.fit import span
from thermodata.report.verdict.candidate_errors import beside
from thermodata.report.verdict.could_hide import could_hide
from thermodata.report.verdict.log_faults import log_faults
from thermodata.report.verdict.verdict import probability, told, verdict_sentence
from thermodata.report.words.glossary import FITTED_TOO, HOW
from thermodata.report.words.numbers import (
    base_role,
    change,
    correlation_text,
    duration,
    heat_lines,
    in_unit,
    number,
    probability_text,
    typeset,
)
from thermodata.report.words.of_response import of_response, some_of
from thermodata.report.words.pieces import names_of_pieces

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Diagnosis
    from thermodata.store import Store


def build_report(store: Store, ref: str, out: Path | str) -> Path:
    """Write the page about a model (id, prefix or name) to `out`; a cut write leaves no half page."""
    from thermodata.report.collected.collect import collect

    return write_page(out, render(collect(store, ref)))


def render(data: ReportData) -> str:
    """The page's HTML. Names and texts from data are escaped; figures stand in it as JSON."""
    styles = effect_styles([*data.effects, *(c.name for t in data.tests for c in t.contributions)])
    spots = ranked_spots(data)
    return str(
        _template().render(
            data=data,
            unit=typeset(data.unit),
            unit_of=lambda found: typeset(data.unit_of(found)),
            styles=styles,
            several=len(data.responses) > 1,
            mixed=len({data.unit_of(name) for name in data.responses}) > 1,
            maps=[str(i or "") for i in range(len(in_one_unit(data.tests, data.unit_of)))],
            weak=[(rank, w, chart_of(data, w), response_of(data, w)) for rank, w in spots],
            tests=[test_row(data, part, f"test{i}") for i, part in enumerate(data.tests)],
            **page_values(figures_of(data, styles, spots)),
            **_ASKED_BY_THE_PAGE,
            **_summary(data),
            **_verdicts(data),
            **_heat_rows(data),
            **_parameter_rows(data),
            **score_rows(data),
        )
    )


def _template() -> Any:
    import jinja2

    environment = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(
        base_role=base_role,
        duration=duration,
        typeset=typeset,
        probability=probability,
        change=change,
        correlation=lambda r: typeset(correlation_text(r)),
        number=lambda value, digits=3: typeset(number(value, digits)),
    )
    return environment.from_string((files("thermodata.report.page") / "page.html.j2").read_text(encoding="utf-8"))


# what the template calls with values of its own
_ASKED_BY_THE_PAGE: dict[str, Any] = {
    "path_styles": path_styles,
    "probability_text": probability_text,
    "of_response": of_response,
    "capital": capital,
    "told": told,
    "beside": beside,
    "how": HOW,
    "fitted_too": FITTED_TOO,
}


def _summary(data: ReportData) -> dict[str, Any]:
    """What stands above the figures: headline, errors, what is left, how the versions became so."""
    errors, at_once = error_rows(data), first_sentences(data)
    rest = [line for line in sentences(data) if line not in at_once]
    return {
        "headline": typeset(headline(data)),
        "first": max(1, len(claim_lines(data))),
        "sentences": [typeset(line) for line in at_once],
        "evidence": [typeset(line) for line in rest],
        "next_test": typeset(data.diagnosis.next_test or "") if data.diagnosis else "",
        "errors": errors,
        "head": headline_error(errors),
        "left": what_is_left(data),
        "waterfall": waterfall(data.versions),
        "refits": [(v.model[:6], typeset(v.refitted)) for v in data.versions if v.refitted],
        "lost": typeset(capital(lost_of_versions(data.versions, lambda v: v.model[:6]))),
        "told_together": some_of(data.told_together, data.responses),
        "locked_note": locked_note(data),
    }


def _verdicts(data: ReportData) -> dict[str, Any]:
    return {
        "verdict": [capital(clause) for clause in clauses(_said(data, data.diagnosis, verdict_sentence))],
        "could_hide": _said(data, data.diagnosis, could_hide),
        "reason": _said(data, data.reason, verdict_sentence),
        "faults": log_faults(data.diagnosis.artefacts) if data.diagnosis else [],
    }


def _heat_rows(data: ReportData) -> dict[str, Any]:
    """The heat that no signal tells, where the diagnosis found some."""
    heat = heat_of(data)
    return {
        "heat": heat,
        "heat_names": names_of_pieces(heat.courses) if heat else [],
        "heat_lines": [(what, typeset(text)) for what, text in heat_lines(heat)] if heat else [],
    }


def _parameter_rows(data: ReportData) -> dict[str, Any]:
    """Parameters by effect, and the checks of the fit that failed."""
    parts = ((key, key.rpartition("."), p) for key, p in data.parameters.items())
    rows = [
        {"effect": effect or key, "name": name, "span": typeset(span(data, key)), **p.model_dump()}
        for key, (effect, _, name), p in parts
    ]
    return {"parameters": rows, "checks": [c for c in data.checks if not c.passed]}


def _said(data: ReportData, found: Diagnosis | None, sentence: Callable[[Diagnosis], str]) -> str:
    """A sentence on a diagnosis, in the unit of its response."""
    return typeset(in_unit(capital(sentence(found)), data.unit_of(found))) if found else ""


def locked_note(data: ReportData) -> str:
    """How often locked data was opened: what was looked at often is no longer a surprise."""
    if not data.looks:
        return "Locked tests: none was opened."
    opened = ", ".join(f"{test} {n} time{'s' if n > 1 else ''}" for test, n in sorted(data.looks.items()))
    return f"Locked tests were opened, for whichever model of the store: {opened}."
