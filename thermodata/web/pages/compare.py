"""Models side by side: one is pinned, the others are told by their difference to it, on its scale."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from starlette.datastructures import QueryParams
from starlette.requests import Request
from starlette.responses import Response

from thermodata.chart.pack import script_json
from thermodata.modelling.compare.common import on_common
from thermodata.modelling.compare.difference import Difference
from thermodata.modelling.compare.differences import Course, between, over_tests
from thermodata.plugin import Float1D
from thermodata.report.data import Version
from thermodata.report.glossary import IN_SAMPLE
from thermodata.report.headline import capital
from thermodata.report.history import chain_units, how_it_went, versions
from thermodata.report.lost import lost_of_compared, lost_of_versions
from thermodata.report.of_response import some_of
from thermodata.report.words import base_role, pooled
from thermodata.schema.result import FitResult, Score
from thermodata.store import Store
from thermodata.store.catalogue.models import find_model, model_chain
from thermodata.view.contributions import Contributions, contributions, open_test, test_names
from thermodata.view.models import ModelRow, model_rows, term_order
from thermodata.view.predictions import residual_courses
from thermodata.view.residuals import Key, predicted_tests, residuals
from thermodata.view.response_units import response_units, told_together
from thermodata.web.chosen import model_in
from thermodata.web.command import command
from thermodata.web.pages.compare_charts import correlated, maps, over_channel
from thermodata.web.pages.contributions import contribution_chart
from thermodata.web.pages.drawn import pair
from thermodata.web.render import desk_of, page

_LISTED = 12  # the newest models, which stand there to be ticked; older ones are folded up
_SAME = 0.005  # of the pinned error: less is no difference


@dataclass(frozen=True, slots=True)
class Line:
    """A test and response: one error for each model, None where it was not predicted."""

    campaign: str
    test: str
    role: str
    response: str
    phase: str
    errors: tuple[float | None, ...]
    differences: tuple[Difference | None, ...] = ()  # of each but the pinned one to it
    in_sample: tuple[bool, ...] = ()  # in which models the test was fitted though it is no calibration test

    @property
    def differs(self) -> bool:
        known = [e for e in self.errors if e is not None]
        return len(known) > 1 and max(known) - min(known) > _SAME * max(known)


def show(request: Request) -> Response:
    """GET /compare: model (several), pin, response, test (of the contributions), over (a channel), differs."""
    desk, given = desk_of(request), request.query_params
    store = desk.store()
    models = model_rows(store)
    if not models:
        return page(request, "compare.html.j2", title="Compare", command="thermodata fit model.yaml", models=[])
    chosen = _chosen(store, models, given.getlist("model"), given.get("pin", ""))
    pinned = chosen[0]
    results = [find_model(store, m.model).result for m in chosen]
    # of all that was scored, as the errors beside them: a test that was taken out of the campaign since, too
    courses = [residual_courses(store, m.model, _scored(r)) for m, r in zip(chosen, results, strict=True)]
    lines = _with_differences(_lines([r.scores for r in results]), courses)
    only = given.get("differs") == "1"
    response = given.get("response") if given.get("response") in pinned.responses else pinned.responses[0]
    keys = predicted_tests(store, pinned.model)
    newest = chosen[-1]
    parts = residuals(store, newest.model, predicted_tests(store, newest.model), str(response))
    over = given.get("over", "")
    stored = model_chain(store, newest.model)
    chain = versions(stored, chain_units(store, stored))
    names_of_all = list(dict.fromkeys(name for m in chosen for name in m.responses))
    units = response_units(store, names_of_all, {c for m in chosen for c in m.campaigns})
    of_response = units.get(str(response), pinned.unit)
    together = told_together(pinned.responses, units)
    names = test_names(keys)
    shown = _shown_test(store, models, pinned.model, given.get("test", ""), lines, keys)
    beside = contributions(store, [m.model for m in chosen], *shown) if shown else []
    labels = {m.model: m.label for m in chosen}
    of_chain = told_together(newest.responses, response_units(store, newest.responses, newest.campaigns))
    order = term_order(models, labels)
    return page(
        request,
        "compare.html.j2",
        title="Compare",
        command=command(desk.store_path, "compare", *(m.model for m in chosen)),
        models=models,
        listed=[m for i, m in enumerate(models) if i < _LISTED or m in chosen],
        older=[m for m in models[_LISTED:] if m not in chosen],
        chosen=chosen,
        pinned=pinned,
        newest=newest,
        unit=pinned.unit,
        lines=[line for line in lines if line.differs or not only],
        hidden=sum(not line.differs for line in lines) if only else 0,
        only=only,
        units=units,
        mixed=len({units.get(line.response) for line in lines}) > 1,
        several=len({line.response for line in lines}) > 1,
        most=_largest(lines, units),
        told_of=some_of(together, pinned.responses),
        told_of_chain=some_of(of_chain, newest.responses),
        roles=_roles(on_common([r.scores for r in results]), together),
        compared=lost_of_compared({m.label: r.scores for m, r in zip(chosen, results, strict=True)}),
        over_roles=_over_roles(lines, [_of_responses(each, together) for each in courses]),
        parameters=_parameters(results),
        heat=[(m, script_json(heat.as_json())) for m, heat in maps(store, chosen, keys, str(response), of_response)],
        in_sample=IN_SAMPLE if any(any(line.in_sample) for line in lines) else None,
        chain=chain,
        waterfall=(waterfall := _waterfall(chain)),
        went=how_it_went([error for _, error, _ in waterfall]),
        lost=capital(lost_of_versions(chain, lambda v: f"{v.name} {chain.index(v) + 1}")),
        undo=_undo(chosen[-1], models),
        autocorrelation=script_json(correlated(parts).as_json()) if parts else None,
        over=over,
        against=script_json(over_channel(store, parts, over, of_response).as_json()) if over and parts else None,
        channels=_channels(store, pinned),
        response=response,
        instead=_instead(given, pinned, newest, str(response), bool(parts)),
        pair=pair,
        tests=names,
        shown_test=shown,
        labels=labels,
        beside=beside,
        beside_charts=[_drawn(part, only, labels, units.get(part.response, pinned.unit), order) for part in beside],
        alike=sum(not e.differs for part in beside for e in part.effects) if only else 0,
        banded=any(sd is not None for part in beside for e in part.effects for sd in e.deviations),
        unpredicted=[labels[m] for m in labels if beside and m not in beside[0].models],
        beside_command=command(desk.store_path, "compare", *labels, "--contributions", names[shown] if shown else ""),
    )


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


def _shown_test(
    store: Store, models: Sequence[ModelRow], pinned: str, named: str, lines: list[Line], keys: list[Key]
) -> Key | None:
    """The named one; unasked, or where the pinned model does not predict it but another does, the one in which the
    errors differ most, else the first; None where none is predicted. UsageError for one that no model predicts."""
    others = (predicted_tests(store, m.model) for m in models if m.model != pinned)
    if named and (_has(keys, named) or not any(_has(theirs, named) for theirs in others)):
        return open_test(store, pinned, named)

    def apart(key: Key) -> float:
        known = [e for line in lines if (line.campaign, line.test) == key for e in line.errors if e is not None]
        return max(known) - min(known) if known else 0.0

    return max(keys, key=apart, default=None)


def _has(keys: Sequence[Key], named: str) -> bool:
    return any(named in (t, f"{c}/{t}") for c, t in keys)


def _drawn(
    part: Contributions, only: bool, labels: dict[str, str], unit: str, order: list[str]
) -> tuple[Contributions, str, str]:
    """What is listed of it, its chart, and the unit of both."""
    shown = replace(part, effects=tuple(e for e in part.effects if e.differs)) if only else part
    return shown, script_json(contribution_chart(shown, labels, unit, order).as_json()), unit


def _chosen(store: Store, models: list[ModelRow], named: list[str], pin: str) -> list[ModelRow]:
    """The pinned one first; unasked, the newest beside the version that it came from. UsageError for an unknown one."""
    by_id = {m.model: m for m in models}
    known = [model_in(store, models, name) for name in filter(None, named)]
    found = list({m.model: m for m in known if m is not None}.values()) or [models[0]]
    if len(found) == 1 and found[0].parent in by_id:
        found = [by_id[found[0].parent], found[0]]
    first = model_in(store, models, pin) if pin else None
    return [first, *(m for m in found if m is not first)] if first else found


def _lines(scores: list[list[Score]]) -> list[Line]:
    keys = {
        (s.campaign, s.test, s.response, s.phase): base_role(s.role)
        for each in scores
        for s in each
        if s.phase == "all"
    }
    known = [{(s.campaign, s.test, s.response, s.phase): s for s in each} for each in scores]
    found = {key: [each.get(key) for each in known] for key in keys}
    return [
        Line(
            *key[:2],
            role,
            *key[2:],
            tuple(s.rmse_um if s else None for s in found[key]),
            in_sample=tuple(s is not None and _in_sample(s) for s in found[key]),
        )
        for key, role in keys.items()
    ]


def _largest(lines: Sequence[Line], units: Mapping[str, str]) -> dict[str | None, float]:
    """unit -> the largest error in it, which is the scale of its bars."""
    found: dict[str | None, float] = {}
    for line in lines:
        unit = units.get(line.response)
        found[unit] = max([found.get(unit, 0.0), *(e for e in line.errors if e is not None)])
    return {unit: most or 1.0 for unit, most in found.items()}


def _in_sample(score: Score) -> bool:
    return score.role != base_role(score.role)


def _with_differences(lines: list[Line], courses: Sequence[Mapping[Course, Float1D]]) -> list[Line]:
    found = [between(courses[0], other) for other in courses[1:]]
    return [
        replace(line, differences=tuple(f.get((line.campaign, line.test, line.response)) for f in found))
        for line in lines
    ]


def _over_roles(
    lines: list[Line], courses: Sequence[Mapping[Course, Float1D]]
) -> list[tuple[str, list[Difference | None]]]:
    """(role, the difference of each but the pinned one to it over the role's tests)."""
    tests: dict[str, dict[tuple[str, str], None]] = {}
    for line in lines:
        tests.setdefault(line.role, {})[line.campaign, line.test] = None
    return [
        (role, [over_tests(courses[0], other, list(keys)) for other in courses[1:]]) for role, keys in tests.items()
    ]


def _of_responses(courses: Mapping[Course, Float1D], responses: Sequence[str]) -> dict[Course, Float1D]:
    return {key: course for key, course in courses.items() if key[2] in responses}


def _roles(scores: list[list[Score]], responses: Sequence[str]) -> list[tuple[str, list[tuple[float | None, bool]]]]:
    """(role, of each model its error, and whether tests of the role were fitted though they are no calibration)."""
    names = dict.fromkeys(base_role(s.role) for each in scores for s in each)
    return [
        (
            role,
            [
                (pooled(each, role, responses=responses), any(_in_sample(s) for s in each if base_role(s.role) == role))
                for each in scores
            ],
        )
        for role in names
    ]


def _parameters(results: Sequence[FitResult]) -> list[tuple[str, list[FitResult | None]]]:
    """(name, those of the results that have it)."""
    names = dict.fromkeys(name for result in results for name in result.readable)
    return [(name, [result if name in result.parameters else None for result in results]) for name in names]


def _waterfall(chain: tuple[Version, ...]) -> list[tuple[Version, float, float | None]]:
    """(version, its error, the error before it)."""
    known = [v for v in chain if v.all_um is not None]
    return [(v, v.all_um or 0.0, known[i - 1].all_um if i else None) for i, v in enumerate(known)]


def _undo(newest: ModelRow, models: list[ModelRow]) -> ModelRow | None:
    return next((m for m in models if m.model == newest.parent), None)


def _channels(store: Store, model: ModelRow) -> list[str]:
    with store.reader() as con:
        rows = con.execute(
            "select channel from channel where list_contains(?, campaign) and quantity <> 'label' "
            "group by channel order by min(rowid)",
            [list(model.campaigns)],
        ).fetchall()
    return [name for (name,) in rows]
