"""Models side by side: one is pinned, the others are told by their difference to it, on its scale."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from starlette.datastructures import QueryParams
from starlette.requests import Request
from starlette.responses import Response

from thermodata.chart.pack import script_json
from thermodata.modelling.compare.common import on_common
from thermodata.modelling.compare.differences import Course
from thermodata.plugin import Float1D
from thermodata.report.collected.lost import lost_of_compared
from thermodata.report.words.glossary import IN_SAMPLE
from thermodata.report.words.of_response import some_of
from thermodata.schema.answers.result import FitResult
from thermodata.store import Store
from thermodata.store.catalogue.models.fits import find_model
from thermodata.store.catalogue.models.stale import stale_line
from thermodata.view.curves.contributions import Contributions, contributions, open_test, test_names
from thermodata.view.curves.predictions import residual_courses
from thermodata.view.curves.residuals import Key, predicted_tests, residuals
from thermodata.view.lists.driven import effects_driven
from thermodata.view.lists.models import ModelRow, fitted_last, model_rows, term_order
from thermodata.view.lists.response_units import response_units, told_together
from thermodata.web.chosen import model_in
from thermodata.web.command import command
from thermodata.web.pages.parts.compare_charts import correlated, maps, over_channel
from thermodata.web.pages.parts.compare_fits import failed_of, parameters_of
from thermodata.web.pages.parts.compare_lines import (
    Line,
    largest,
    lines_of,
    of_responses,
    over_roles,
    roles,
    unseen,
    with_differences,
)
from thermodata.web.pages.parts.compare_versions import how_it_fell, refitted
from thermodata.web.pages.parts.contributions import contribution_chart
from thermodata.web.pages.parts.drawn import pair
from thermodata.web.render import desk_of, page

_LISTED = 12  # the newest models, which stand there to be ticked; older ones are folded up


def show(request: Request) -> Response:
    """GET /compare: model (several), pin, response, test (of the contributions), over (a channel), differs."""
    desk, given = desk_of(request), request.query_params
    store = desk.store()
    models = model_rows(store)
    if not models:
        return page(request, "compare.html.j2", title="Compare", command="thermodata fit model.yaml", models=[])
    compared = _compared(store, models, given)
    return page(
        request,
        "compare.html.j2",
        title="Compare",
        command=command(desk.store_path, "compare", *(m.model for m in compared.chosen)),
        pair=pair,
        **_form(compared),
        **_headline(compared),
        **how_it_fell(store, models, compared.newest, desk.store_path),
        **_residuals(compared, given),
        **_contributions(compared, desk.store_path, given.get("test", "")),
        **_test_by_test(compared),
        parameters=parameters_of(compared.results),
        failed=failed_of(compared.chosen, compared.results),
    )


@dataclass(frozen=True, slots=True)
class _Compared:
    """models: all of the store; chosen: the pinned one first; results, courses: of each of these, in their order.
    predicted: tests that the pinned one predicts. stale: a line on each whose data changed since its fit. response: of
    which the page shows what it shows of one. only: what differs. units: response -> unit."""

    store: Store
    models: list[ModelRow]
    chosen: list[ModelRow]
    results: list[FitResult]
    courses: list[dict[Course, Float1D]]
    lines: list[Line]
    predicted: list[Key]
    stale: list[str]
    response: str
    only: bool
    units: Mapping[str, str]

    @property
    def pinned(self) -> ModelRow:
        return self.chosen[0]

    @property
    def campaigns(self) -> set[str]:
        """Of all that are chosen: where they are several, a test is named with its own."""
        return {c for m in self.chosen for c in m.campaigns}

    @property
    def newest(self) -> ModelRow:
        return self.chosen[-1]

    @property
    def errors(self) -> dict[str, dict[Key, float]]:
        """model -> the error of the response in each test."""
        own = [line for line in self.lines if line.response == self.response]
        return {
            m.model: {(line.campaign, line.test): e for line in own if (e := line.errors[i]) is not None}
            for i, m in enumerate(self.chosen)
        }

    @property
    def together(self) -> Sequence[str]:
        """The responses whose errors can be told as one."""
        return told_together(self.pinned.responses, self.units)


def _compared(store: Store, models: list[ModelRow], given: QueryParams) -> _Compared:
    chosen = _chosen(store, models, given.getlist("model"), given.get("pin", ""))
    results = [find_model(store, m.model).result for m in chosen]
    stale = [line for m in chosen if (line := stale_line(store, m.model))]
    # of all that was scored, as the errors beside them: a test that was taken out of the campaign since, too; but a
    # difference to a fit to other data would be that of the data
    of_each = zip(chosen, results, strict=True)
    courses = [{} if stale else residual_courses(store, m.model, _scored(r)) for m, r in of_each]
    named, known = given.get("response"), chosen[0].responses
    names_of_all = list(dict.fromkeys(name for m in chosen for name in m.responses))
    return _Compared(
        store,
        models,
        chosen,
        results,
        courses,
        with_differences(lines_of([r.scores for r in results]), courses),
        predicted_tests(store, chosen[0].model),
        stale,
        response=named if named in known else known[0],
        only=given.get("differs") == "1",
        units=response_units(store, names_of_all, {c for m in chosen for c in m.campaigns}),
    )


def _form(of: _Compared) -> dict[str, Any]:
    """The models, by which one chooses, and the channels to draw over."""
    newest = [m for m in of.models[:_LISTED] if m not in of.chosen]
    return {
        "models": of.models,
        "listed": [*of.chosen, *newest],  # what is ticked is seen without looking for it
        "older": [m for m in of.models[_LISTED:] if m not in of.chosen],
        "chosen": of.chosen,
        "pinned": of.pinned,
        "newest": of.newest,
        "only": of.only,
        "response": of.response,
        "channels": _channels(of.store, of.pinned),
    }


def _headline(of: _Compared) -> dict[str, Any]:
    scores = [r.scores for r in of.results]
    return {
        "unit": of.pinned.unit,
        "stale": of.stale,
        "told_of": some_of(of.together, of.pinned.responses),
        "roles": roles(on_common(scores), of.together),
        "refitted": refitted(of.store, of.pinned, of.newest, scores[0], scores[-1]),
        "compared": lost_of_compared({m.label: own for m, own in zip(of.chosen, scores, strict=True)}),
    }


def _residuals(of: _Compared, given: QueryParams) -> dict[str, Any]:
    """Of the one response, over the tests, over a channel and by itself."""
    over, unit = given.get("over", ""), of.units.get(of.response, of.pinned.unit)
    parts = residuals(of.store, of.newest.model, predicted_tests(of.store, of.newest.model), of.response)
    heat = maps(of.store, of.chosen, test_names(of.predicted, of.campaigns), of.response, unit, of.errors)
    return {
        "heat": [(m, script_json(chart.as_json())) for m, chart in heat],
        "over": over,
        "against": script_json(over_channel(of.store, parts, over, unit).as_json()) if over and parts else None,
        "autocorrelation": script_json(correlated(parts).as_json()) if parts else None,
        "instead": _instead(given, of.pinned, of.newest, of.response, bool(parts)),
    }


def _contributions(of: _Compared, store_path: Path, named: str) -> dict[str, Any]:
    """What each effect gives in one test. named: that test; '' where nobody asked for one."""
    names = test_names(of.predicted, of.campaigns)
    shown = _shown_test(of, named)
    beside = contributions(of.store, [m.model for m in of.chosen], *shown) if shown else []
    labels = {m.model: m.label for m in of.chosen}
    order, driven = term_order(of.models, labels), effects_driven(of.store, [*labels])
    return {
        "driven": driven,
        "tests": names,
        "shown_test": shown,
        "labels": labels,
        "beside": beside,
        "beside_charts": [
            _drawn(part, of.only, labels, of.units.get(part.response, of.pinned.unit), order, driven) for part in beside
        ],
        "alike": sum(not e.differs for part in beside for e in part.effects) if of.only else 0,
        "banded": any(sd is not None for part in beside for e in part.effects for sd in e.deviations),
        "unpredicted": [labels[m] for m in labels if beside and m not in beside[0].models],
        "beside_command": command(store_path, "compare", *labels, "--contributions", names[shown] if shown else ""),
    }


def _test_by_test(of: _Compared) -> dict[str, Any]:
    return {
        "lines": [line for line in of.lines if line.differs or not of.only],
        "hidden": sum(not line.differs for line in of.lines) if of.only else 0,
        "units": of.units,
        "mixed": len({of.units.get(line.response) for line in of.lines}) > 1,
        "several": len({line.response for line in of.lines}) > 1,
        "several_campaigns": len(of.campaigns) > 1,
        "most": largest(of.lines, of.units),
        "over_roles": over_roles(of.lines, [of_responses(each, of.together) for each in of.courses]),
        "unseen": unseen(of.lines),
        "in_sample": IN_SAMPLE if any(any(line.in_sample) for line in of.lines) else None,
    }


def _instead(given: QueryParams, pinned: ModelRow, newest: ModelRow, response: str, predicted: bool) -> list[str]:
    """What is shown in place of what the address asks for. predicted: whether there is a residual of the newest."""
    named, over = given.get("response") or response, given.get("over")
    found = []
    if named != response:
        of = ", ".join(pinned.responses)
        found.append(
            f"{pinned.label} has no response '{named}' (it has {of}): what is of one response is of {response}."
        )
    if over and not predicted:
        found.append(f"No residual over {over}: {newest.label} does not predict {response}.")
    return found


def _scored(result: FitResult) -> list[Key]:
    return list(dict.fromkeys((s.campaign, s.test) for s in result.scores))


def _shown_test(of: _Compared, named: str) -> Key | None:
    """The named one; unasked, or where the pinned model does not predict it but another does, the one in which the
    errors differ most, else the first; None where none is predicted. UsageError for one that no model predicts."""
    pinned = of.pinned.model
    others = (predicted_tests(of.store, m.model) for m in of.models if m.model != pinned)
    if named and (_has(of.predicted, named) or not any(_has(theirs, named) for theirs in others)):
        return open_test(of.store, pinned, named)

    def apart(key: Key) -> float:
        known = [e for line in of.lines if (line.campaign, line.test) == key for e in line.errors if e is not None]
        return max(known) - min(known) if known else 0.0

    return max(of.predicted, key=apart, default=None)


def _has(keys: Sequence[Key], named: str) -> bool:
    return any(named in (t, f"{c}/{t}") for c, t in keys)


def _drawn(
    part: Contributions, only: bool, labels: dict[str, str], unit: str, order: list[str], driven: dict[str, str]
) -> tuple[Contributions, str, str]:
    """What is listed of it, its chart, and the unit of both."""
    shown = replace(part, effects=tuple(e for e in part.effects if e.differs)) if only else part
    return shown, script_json(contribution_chart(shown, labels, unit, order, driven).as_json()), unit


def _chosen(store: Store, models: list[ModelRow], named: list[str], pin: str) -> list[ModelRow]:
    """The pinned one first; unasked, the newest beside the version that it came from. UsageError for an unknown one."""
    by_id = {m.model: m for m in models}
    known = [model_in(store, models, name) for name in filter(None, named)]
    found = list({m.model: m for m in known if m is not None}.values()) or [fitted_last(models)]
    if len(found) == 1 and found[0].parent in by_id:
        found = [by_id[found[0].parent], found[0]]
    first = model_in(store, models, pin) if pin else None
    return [first, *(m for m in found if m is not first)] if first else found


def _channels(store: Store, model: ModelRow) -> list[str]:
    with store.reader() as con:
        rows = con.execute(
            "select channel from channel where list_contains(?, campaign) and quantity <> 'label' "
            "group by channel order by min(rowid)",
            [list(model.campaigns)],
        ).fetchall()
    return [name for (name,) in rows]
