"""Renders ReportData as one HTML page that needs nothing beside it."""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.chart import Chart, HeatMap, effect_styles
from thermodata.chart.decimate import block_mean
from thermodata.report.charts.bars import waterfall
from thermodata.report.charts.figures import in_one_unit, overview_map, part_chart, points_for, residual_scale
from thermodata.report.charts.heat import heat_charts
from thermodata.report.charts.system import path_styles, system_charts
from thermodata.report.collected.data import ReportData, TestPart
from thermodata.report.collected.lost import lost_of_versions
from thermodata.report.page.error_rows import error_rows, headline_error
from thermodata.report.page.headline import capital, headline, sentences
from thermodata.report.page.write import page_values, write_page
from thermodata.report.text.clauses import clauses
from thermodata.report.text.fit import span
from thermodata.report.verdict.candidate_errors import beside
from thermodata.report.verdict.could_hide import could_hide
from thermodata.report.verdict.log_faults import log_faults
from thermodata.report.verdict.verdict import probability, told, verdict_sentence
from thermodata.report.words.glossary import HOW, NOISE
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
    from thermodata.schema.answers.diagnosis import Diagnosis, WeakSpot
    from thermodata.schema.answers.missing_heat import MissingHeat
    from thermodata.store import Store

SPOTS_SHOWN = 10
SLOW_S = 1800.0
"""An error that keeps its sign for so long is systematic [s]."""
FEW = 2
"""Means of a calibration test, the last of them of less, that tell nothing slow."""


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
            weak=[(rank, w, _box(data, w), _response_of(data, w)) for rank, w in spots],
            tests=[_test(data, part, f"test{i}") for i, part in enumerate(data.tests)],
            **page_values(_figures(data, styles, spots)),
            **_ASKED_BY_THE_PAGE,
            **_summary(data),
            **_verdicts(data),
            **_heat_rows(data),
            **_parameter_rows(data),
            **_score_rows(data),
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
}


def _summary(data: ReportData) -> dict[str, Any]:
    """What stands above the figures: headline, errors, what is left, how the versions became so."""
    errors = error_rows(data)
    return {
        "headline": typeset(headline(data)),
        "sentences": [typeset(line) for line in sentences(data)],
        "errors": errors,
        "head": headline_error(errors),
        "left": what_is_left(data),
        "waterfall": waterfall(data.versions),
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
    heat = _heat(data)
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


def ranked_spots(data: ReportData) -> list[tuple[int, WeakSpot]]:
    """The weak spots of all responses that are worth a look, the costliest first, from 1 on; those in another unit than
    the first response's have no common cost with it, and stand behind."""
    found = [(data.unit_of(name) != data.unit, w) for name, spots in data.weak.items() for w in spots]
    costliest = sorted(found, key=lambda one: (one[0], -(one[1].rmse_um ** 2) * (one[1].to_s - one[1].from_s)))
    return list(enumerate((w for _, w in costliest[:SPOTS_SHOWN]), 1))


def _figures(
    data: ReportData, styles: dict[str, tuple[str, str]], spots: list[tuple[int, WeakSpot]]
) -> dict[str, Chart | HeatMap]:
    made: dict[str, Chart | HeatMap] = {}
    several, first = len(data.responses) > 1, in_one_unit(data.first, data.unit_of)
    for i, (unit, now) in enumerate(in_one_unit(data.tests, data.unit_of).items()):
        at, before = str(i or ""), first.get(unit, [])
        limit = residual_scale([t.residual for t in before or now])
        if before:
            about = f"Residual of every test in the first version, {data.versions[0].name}"
            made[f"first{at}"] = overview_map(before, unit, limit, [""] * len(before), about, "", several=several)
        note = "" if i else "Point at a strip to read it; click to see its test there."
        targets = [f"test{j}" for j, t in enumerate(data.tests) if data.unit_of(t.response) == unit]
        made[f"overview{at}"] = overview_map(now, unit, limit, targets, "Residual of every test", note, several=several)
    if heat := _heat(data):
        drawn = heat_charts(heat.courses, data.unit_of(data.diagnosis), heat.direction is not None)
        made.update({f"heat{i}": figure for i, figure in enumerate(drawn)})
    for i, seen in enumerate(data.systems):
        made.update({f"system{i}-{name}": drawn for name, drawn in system_charts(seen, styles).items()})
    most = points_for(data.tests)
    for i, part in enumerate(data.tests):
        own = [(rank, w) for rank, w in spots if _is_of(part, data, w)]
        made[f"test{i}"] = part_chart(part, own, styles, _noise(data, part.response), data.unit_of(part.response), most)
    return made


def _is_of(part: TestPart, data: ReportData, spot: WeakSpot) -> bool:
    same = (spot.campaign, spot.test) == (part.campaign, part.test)
    return same and any(w is spot for w in data.weak.get(part.response, ()))


def _response_of(data: ReportData, spot: WeakSpot) -> str:
    return next((name for name, spots in data.weak.items() if any(w is spot for w in spots)), "")


def _box(data: ReportData, spot: WeakSpot) -> str:
    """The id of the chart that shows it, '' where there is none."""
    return next((f"test{i}" for i, part in enumerate(data.tests) if _is_of(part, data, spot)), "")


def _noise(data: ReportData, response: str) -> float | None:
    found = (d for d in (data.diagnosis, data.reason) if d and d.response == response)
    return next((d.noise_um for d in found if d.noise_um), None)


def _heat(data: ReportData) -> MissingHeat | None:
    return data.diagnosis.unknown.heat if data.diagnosis and data.diagnosis.unknown else None


def what_is_left(data: ReportData) -> list[tuple[str, str, str]]:
    """(what, figure, note): the residual of all open tests, what of it is slow, and the noise; of the responses in the
    unit of the first."""
    tests = [p for p in data.tests if p.response in data.told_together]
    if not tests:
        return []
    step = tests[0].step_s
    whole = _rms([p.residual for p in tests])
    sizes = [max(1, round(SLOW_S / p.step_s)) for p in tests]
    # about zero by the fit, a calibration test of few such means has none that could keep a sign: alone it tells none
    telling = any(p.role != "calibration" or len(p.residual) > FEW * size for p, size in zip(tests, sizes, strict=True))
    slow = _rms([_slow(p.residual, size) for p, size in zip(tests, sizes, strict=True)]) if telling else None
    of = f", of {' and '.join(data.told_together)}" if len(data.responses) > 1 else ""
    noises = ((name, _noise(data, name)) for name in data.told_together)
    noisy, noise = next(((name, n) for name, n in noises if n is not None), ("", None))
    length = NOISE.format(length=duration(step))
    rows = [
        ("left over in all open tests", whole, f"calibration and verification tests together{of}"),
        (f"of it, in means of {duration(SLOW_S)}", slow, "keeps its sign for long: systematic, not noise"),
        ("noise", noise, f"of {noisy}: {length}" if of else length),
    ]
    return [(what, number(value), note) for what, value, note in rows if value is not None]


def _slow(residual: np.ndarray, size: int) -> np.ndarray:
    """At each sample the mean of its block, so that a block weighs what it holds: the last one may hold one sample."""
    means = np.repeat(block_mean(residual, size), size)[: len(residual)]
    return np.where(np.isfinite(residual), means, np.nan)


def _rms(residuals: list[np.ndarray]) -> float | None:
    seen = np.concatenate([np.zeros(0), *(r[np.isfinite(r)] for r in residuals)])
    return float(np.sqrt(np.mean(seen**2))) if len(seen) else None


def locked_note(data: ReportData) -> str:
    """How often locked data was opened: what was looked at often is no longer a surprise."""
    if not data.looks:
        return "Locked tests: none was opened."
    opened = ", ".join(f"{test} {n} time{'s' if n > 1 else ''}" for test, n in sorted(data.looks.items()))
    return f"Locked tests were opened, for whichever model of the store: {opened}."


def _test(data: ReportData, part: TestPart, key: str) -> dict[str, Any]:
    row = next(
        (
            s
            for s in data.scores
            if (s.campaign, s.test, s.response, s.phase) == (part.campaign, part.test, part.response, "all")
        ),
        None,
    )
    title = part.test if len(data.campaigns) == 1 else f"{part.campaign} / {part.test}"
    conditions = ", ".join(f"{k} {number(v) if isinstance(v, float) else v}" for k, v in part.conditions.items())
    length = duration(part.step_s * len(part.measured))
    facts = f"RMSE {number(row.rmse_um)} {data.unit_of(part.response)} · FIT {number(row.fit)} %" if row else ""
    return {
        "part": part,
        "key": key,
        "title": title if len(data.responses) == 1 else f"{title} · {part.response}",
        "about": typeset(" · ".join(filter(None, [part.kind.replace("_", " "), length, conditions]))),
        "facts": typeset(facts),
    }


def _score_rows(data: ReportData) -> dict[str, Any]:
    before = {(s.campaign, s.test, s.response): s.rmse_um for s in data.before if s.phase == "all"}
    rows = [{"row": s, "before": before.get((s.campaign, s.test, s.response))} for s in data.scores if s.phase == "all"]
    most: dict[str, float] = {}
    for s in data.scores:
        if s.phase == "all":
            unit, both = data.unit_of(s.response), (before.get((s.campaign, s.test, s.response)), s.rmse_um)
            most[unit] = max([most.get(unit, 0.0), *(e for e in both if e is not None)])
    found = [c for d in (data.diagnosis, data.reason) if d for c in d.candidates]
    tried = [e for c in found for e in (c.rmse_um_before, c.rmse_um_after) if e]
    phased = [s for s in data.scores if s.phase != "all"]
    return {"whole": rows, "phased": phased, "most_score": most, "most_candidate": max(tried, default=1.0)}
