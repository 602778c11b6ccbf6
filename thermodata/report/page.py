"""Renders ReportData as one HTML page that needs nothing beside it."""

from __future__ import annotations

import re
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.report.colour import effect_colours
from thermodata.report.data import ReportData, TestPart
from thermodata.report.figures import Figure, overview_figure, test_figure, waterfall_figure
from thermodata.report.heat_figure import heat_figures
from thermodata.report.verdict import claims_of, explainable, listed, named, probability, told, verdict_sentence
from thermodata.report.words import base_role, change, duration, heat_lines, number, pooled, typeset
from thermodata.report.write import script_json, write_page
from thermodata.version import __version__

if TYPE_CHECKING:
    from thermodata.schema.result import MissingHeat
    from thermodata.store import Store


def build_report(store: Store, ref: str, out: Path | str) -> Path:
    """Write the page about a model (id, prefix or name) to `out`; a cut write leaves no half page."""
    from thermodata.report.collect import collect

    return write_page(out, render(collect(store, ref)))


def render(data: ReportData) -> str:
    """The page's HTML. Names and texts from data are escaped; figures stand in it as JSON."""
    import jinja2
    from markupsafe import Markup
    from plotly.offline import get_plotlyjs

    here = files("thermodata.report")
    environment = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(
        base_role=base_role,
        duration=duration,
        typeset=typeset,
        probability=probability,
        number=lambda value, digits=3: typeset(number(value, digits)),
    )
    template = environment.from_string((here / "page.html.j2").read_text(encoding="utf-8"))
    colours = effect_colours([*data.effects, *(c.name for t in data.tests for c in t.contributions)])
    figures = _figures(data, colours)
    heat = _heat(data)
    return template.render(
        data=data,
        unit=typeset(data.unit),
        version=__version__,
        colours=colours,
        figures=figures,
        json={key: Markup(script_json(figure)) for key, figure in figures.items()},
        css=Markup((here / "page.css").read_text(encoding="utf-8")),
        js=Markup((here / "page.js").read_text(encoding="utf-8")),
        plotly=Markup(get_plotlyjs()),
        overview="overview" in figures,
        waterfall="waterfall" in figures,
        heat=heat,
        heat_lines=[(what, typeset(text)) for what, text in heat_lines(heat)] if heat else [],
        weak=sorted((w for found in data.weak.values() for w in found), key=lambda w: -w.rmse_um),
        headline=typeset(headline(data)),
        sentences=[typeset(line) for line in _sentences(data)],
        tiles=tiles(data),
        verdict=typeset(_capital(verdict_sentence(data.diagnosis))) if data.diagnosis else "",
        reason=typeset(_capital(verdict_sentence(data.reason))) if data.reason else "",
        tests=[_test(data, part, f"test{i}") for i, part in enumerate(data.tests)],
        parameters=[
            {"effect": key.rpartition(".")[0] or key, "name": key.rpartition(".")[2], **p.model_dump()}
            for key, p in data.parameters.items()
        ],
        checks=[c for c in data.checks if not c.passed],
        told=told,
        several=len(data.responses) > 1,
        phased=[s for s in data.scores if s.phase != "all"],
        locked_note=locked_note(data),
        **_score_rows(data),
    )


def _figures(data: ReportData, colours: dict[str, str]) -> dict[str, Figure]:
    noise = next((d.noise_um for d in (data.diagnosis, data.reason) if d and d.noise_um), None)
    made: dict[str, Figure] = {}
    if data.tests:
        made["overview"] = overview_figure(data.tests, typeset(data.unit))
    if len(data.versions) > 1 and sum(v.all_um is not None for v in data.versions) > 1:
        made["waterfall"] = waterfall_figure(data.versions, noise, typeset(data.unit))
    heat = _heat(data)
    if heat:
        drawn = heat_figures(heat.courses, typeset(data.unit), heat.direction is not None)
        made.update({f"heat{i}": figure for i, figure in enumerate(drawn)})
    for i, part in enumerate(data.tests):
        weak = [w for w in data.weak.get(part.response, ()) if (w.campaign, w.test) == (part.campaign, part.test)]
        made[f"test{i}"] = test_figure(part, weak, colours, noise, typeset(data.unit))
    return made


def _heat(data: ReportData) -> MissingHeat | None:
    return data.diagnosis.unknown.heat if data.diagnosis and data.diagnosis.unknown else None


def headline(data: ReportData) -> str:
    """The page's first sentence: what was added and what it did, or the verdict, or the plain error."""
    roles = ("calibration", "verification")
    before, after = pooled(data.before, *roles), pooled(data.scores, *roles)
    if data.added and before and after is not None:
        if after >= before:
            return f"{data.added} does not lower the error: {number(before)} -> {number(after)} {data.unit}"
        return (
            f"With {data.added} the error of {', '.join(data.responses)} falls from {number(before)} to "
            f"{number(after)} {data.unit} ({change(before, after)})"
        )
    if data.diagnosis:
        claims = claims_of(data.diagnosis)
        if claims:
            return f"{', '.join(data.responses)} misses {listed([named(c) for c in claims])}"
        return _capital(verdict_sentence(data.diagnosis))
    return f"{data.name} follows {', '.join(data.responses)} to {number(after)} {data.unit}"


def _sentences(data: ReportData) -> list[str]:
    lines = []
    if data.added and data.reason:
        claims = claims_of(data.reason)
        for claim in claims:
            # ids stay as they are typed
            why, it = (f"{claim.id}: {claim.why}", claim.id) if len(claims) > 1 else (_capital(claim.why), "it")
            if claim.why:
                lines.append(why + ("" if why.endswith(".") else "."))
            if claim.equivalent:
                lines.append(f"These tests can't tell {it} from {listed(claim.equivalent)}.")
    if data.diagnosis:
        lines.append(("Now: " if data.added else "") + _capital(verdict_sentence(data.diagnosis)) + ".")
    return lines


def tiles(data: ReportData) -> list[dict[str, str]]:
    """Key figures: error by role before and after, FIT, noise."""
    made = []
    for role, what in (("calibration", "Error in calibration tests"), ("verification", "Error in verification tests")):
        after, before = pooled(data.scores, role), pooled(data.before, role)
        if after is not None:
            in_sample = any("in-sample" in s.role for s in data.scores if base_role(s.role) == role)
            note = "took part in choosing the effect" if in_sample else "RMSE, free-run"
            made.append(_tile(what, before, after, data.unit, note))
    locked = _locked(data)
    if locked:
        made.append(_tile("Error in locked tests", *locked, data.unit, "took no part in the choice"))
    fits = sorted(s.fit for s in data.scores if s.phase == "all" and s.fit is not None)
    if fits:
        made.append(
            {
                "what": "FIT, median over tests",
                "was": "",
                "value": number(fits[len(fits) // 2]),
                "unit": "%",
                "badge": "",
                "tone": "",
                "note": f"worst {number(fits[0])} %, best {number(fits[-1])} %",
            }
        )
    found = data.diagnosis or data.reason
    if found and found.noise_um:
        made.append(_tile("Noise of the measurement", None, found.noise_um, data.unit, explainable(found)))
    return made


def _tile(what: str, before: float | None, after: float, unit: str, note: str) -> dict[str, str]:
    better = before is not None and after < before
    return {
        "what": what,
        "was": number(before) if before is not None else "",
        "value": number(after),
        "unit": typeset(unit),
        "badge": typeset(change(before, after)) if before is not None else "",
        "tone": "good" if better else "bad",
        "note": note,
    }


def _locked(data: ReportData) -> tuple[float | None, float] | None:
    """Locked error (before, after): of the claims that were confirmed where all were added, else of the model's own
    scores."""
    claims = claims_of(data.reason) if data.reason else []
    added = all(any(re.fullmatch(rf"{re.escape(c.effect)}(_\d+)?", term) for term in data.effects) for c in claims)
    if data.added and claims and added and claims[0].locked_rmse_um_after is not None:
        return claims[0].locked_rmse_um_before, claims[0].locked_rmse_um_after
    after = pooled(data.scores, "locked")
    return None if after is None else (pooled(data.before, "locked"), after)


def locked_note(data: ReportData) -> str:
    """How often locked data was opened: what was looked at often is no longer a surprise."""
    if not data.looks:
        return "Locked tests: none was opened for this model or its ancestors."
    opened = ", ".join(f"{test} {n} time{'s' if n > 1 else ''}" for test, n in sorted(data.looks.items()))
    return f"Locked tests were opened for this model and its ancestors: {opened}."


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
    facts = f"RMSE {number(row.rmse_um)} {data.unit} · FIT {number(row.fit)} %" if row else ""
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
    errors = [e for r in rows for e in (r["before"], getattr(r["row"], "rmse_um", None)) if isinstance(e, float)]
    found = [c for d in (data.diagnosis, data.reason) if d for c in d.candidates]
    tried = [e for c in found for e in (c.rmse_um_before, c.rmse_um_after) if e]
    return {"whole": rows, "most_score": max(errors, default=1.0) or 1.0, "most_candidate": max(tried, default=1.0)}


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
