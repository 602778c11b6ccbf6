"""One test: its curves in any window, and from any point back to the row of a file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from thermodata.chart.pack import script_json
from thermodata.chart.parts import Strip
from thermodata.chart.spec import Chart
from thermodata.errors import UsageError
from thermodata.report.words.glossary import IN_SAMPLE
from thermodata.report.words.numbers import base_role
from thermodata.store import Store
from thermodata.view.curves.predictions import Prediction, predictions, range_figures
from thermodata.view.curves.rule_for import rules_for
from thermodata.view.curves.window import Channel, Window, channels_of, read_window
from thermodata.view.lists.alike import folded
from thermodata.view.lists.driven import effects_driven
from thermodata.view.lists.events import About, about_test
from thermodata.view.lists.models import ModelRow, model_rows, read_by, role_in_model, term_order
from thermodata.view.lists.response_units import measured_units, response_units
from thermodata.web.chosen import WITHOUT, model_in
from thermodata.web.command import command
from thermodata.web.pages.parts.test_chart import NO_MODEL, OfModel, drawn_as_curve, test_chart
from thermodata.web.query import seconds_in
from thermodata.web.render import desk_of, page

_MOST_CURVES, _MOST_STRIPS = 24, 10  # that are drawn unasked: more are chosen by name
_MOST_ADDRESS = 8_000  # [letters] of names


def show(request: Request) -> Response:
    """GET /test: campaign, test, model, from, to [s], show (channels, or 'all'), flagged."""
    desk, given = desk_of(request), _asked(request)
    store = desk.store()
    campaign, test = _named(given)
    known = _known(store, campaign, test)
    models, about = known.models, known.about
    model = _model(store, models, given)
    channels, chosen = _channels(store, known, model, given)
    predicted = _predicted(store, model, given)
    role = role_in_model(store, model.model, campaign, test) if model else None
    span = _span(given)
    moving = _moving(store, about, chosen, given) if span else chosen
    of_model = _of_model(store, campaign, predicted, models, model)
    chart = _chart(store, about, moving, of_model, given, named=moving is not chosen)
    return page(
        request,
        "test.html.j2",
        title=test,
        section="/",
        command=command(desk.store_path, "trace", campaign, test),
        about=about,
        alike=folded(about.flagged),
        channels=channels,
        drawn=_drawn(chart, moving) or given.get("show", ""),
        chosen={c.name for c in chosen},
        shown=given.get("show", ""),
        named=set(given.get("show", "").split(",")) if _by_name(given) else set(),
        errors=_errors(store, campaign, predicted),
        models=models,
        model=model,
        predicted=predicted,
        model_role=role,
        stale=_stale(store, model),
        in_sample=IN_SAMPLE if role and role != base_role(role) else None,
        banded=any(p.deviations for p in predicted),
        chart=script_json(chart.as_json()),
        span=span and (span[0] / 3600, span[1] / 3600),
        neighbours=_neighbours(store, campaign, test),
        flagged=given.get("flagged") == "1",
    )


def data(request: Request) -> Response:
    """GET /test/data: the chart of a window in as many points as a screen has."""
    store, given = desk_of(request).store(), _asked(request)
    known = _known(store, *_named(given))
    model = _model(store, known.models, given)
    _, chosen = _channels(store, known, model, given)
    of_model = _of_model(store, _named(given)[0], _predicted(store, model, given), known.models, model)
    chart = _chart(store, known.about, chosen, of_model, given)
    return JSONResponse(chart.as_json())


def stretch(request: Request) -> Response:
    """GET /test/range: what a stretch (from, to) does to the error, and the lines that would keep or name it."""
    store, given = desk_of(request).store(), request.query_params
    campaign, test = _named(given)
    channels = channels_of(store, campaign, test)
    from_s, to_s = seconds_in(given, "from"), seconds_in(given, "to")
    if from_s is None or to_s is None or not from_s < to_s:
        raise UsageError(
            "a stretch has a beginning and an end",
            expected="from < to, in seconds",
            hint="draw it from left to right in the chart, or give both",
        )
    models = [m for m in model_rows(store) if campaign in m.campaigns]
    found = _predicted(store, _model(store, models, given), given)
    return page(
        request,
        "test_range.html.j2",
        title="",
        command="",
        from_s=from_s,
        to_s=to_s,
        campaign=campaign,
        test=test,
        figures=[(p.response, range_figures(p, from_s, to_s)) for p in found],
        rules=[
            (p.response, range_figures(p, from_s, to_s), rules_for(store, p, channels, from_s, to_s)) for p in found
        ],
        units=response_units(store, [p.response for p in found], [campaign]),
    )


def _asked(request: Request) -> dict[str, str]:
    """The address; of channels that are ticked one by one, 'show' holds all, parted by commas."""
    given = request.query_params
    several = [name for name in given.getlist("show") if name]
    return {**given, "show": "all" if "all" in several else ",".join(dict.fromkeys(several))}


def _errors(store: Store, campaign: str, predicted: list[Prediction]) -> list[tuple[str, float, str]]:
    """(response, error over the whole test, its unit), of the model that is shown."""
    units = response_units(store, [p.response for p in predicted], [campaign])
    found = [(p.response, range_figures(p, -math.inf, math.inf).rmse, units.get(p.response, "um")) for p in predicted]
    return [(response, error, unit) for response, error, unit in found if error is not None]


def _named(given: Mapping[str, str]) -> tuple[str, str]:
    return given.get("campaign", ""), given.get("test", "")


@dataclass(frozen=True, slots=True)
class _UntilCommit:
    """What a commit may change, and a zoom does not. models: those of the test's campaign."""

    channels: list[Channel]
    models: list[ModelRow]
    about: About


def _known(store: Store, campaign: str, test: str) -> _UntilCommit:
    mark = store.mark()
    return _known_at(store, campaign, test, mark) if mark else _known_at.__wrapped__(store, campaign, test, mark)


@lru_cache(maxsize=16)
def _known_at(store: Store, campaign: str, test: str, mark: str) -> _UntilCommit:
    """mark: of the commit; read before what it stands for, so that nothing newer is taken for older."""
    channels = channels_of(store, campaign, test)
    models = [m for m in model_rows(store) if campaign in m.campaigns]
    return _UntilCommit(channels, models, about_test(store, campaign, test))


def _channels(
    store: Store, found: _UntilCommit, model: ModelRow | None, given: Mapping[str, str]
) -> tuple[list[Channel], list[Channel]]:
    """(all, those to draw). Unasked, as many as can be told apart, those that the model reads and explains first."""
    known = found.channels
    names = given.get("show", "")
    if names == "all":
        return known, known
    if not names:
        curves = [c for c in known if drawn_as_curve(c)]
        strips = [c for c in known if not drawn_as_curve(c)]
        if len(curves) <= _MOST_CURVES and len(strips) <= _MOST_STRIPS:
            return known, [*curves, *strips]
        of_model = {*read_by(store, model.model, [c.name for c in known]), *model.responses} if model else set[str]()
        return known, [*_first(curves, _MOST_CURVES, of_model), *_first(strips, _MOST_STRIPS, of_model)]
    wanted = set(names.split(","))
    return known, [c for c in known if c.name in wanted]


def _first(channels: list[Channel], most: int, wanted: set[str]) -> list[Channel]:
    """So many of them in their order, the wanted ones in any case before the others."""
    kept = {c.name for c in sorted(channels, key=lambda c: c.name not in wanted)[:most]}
    return [c for c in channels if c.name in kept]


def _model(store: Store, models: list[ModelRow], given: Mapping[str, str]) -> ModelRow | None:
    """models: those of the test's campaign, which alone predict it."""
    named = given.get("model", "")
    return None if named == WITHOUT else model_in(store, models, named)


def _stale(store: Store, model: ModelRow | None) -> str | None:
    if model is None or not model.stale:
        return None
    from thermodata.store.catalogue.models.stale import stale_line  # it loads model files, which no plot needs

    return stale_line(store, model.model)


def _predicted(store: Store, model: ModelRow | None, given: Mapping[str, str]) -> list[Prediction]:
    return predictions(store, model.model, *_named(given)) if model else []


def _of_model(
    store: Store, campaign: str, predicted: list[Prediction], models: list[ModelRow], model: ModelRow | None
) -> OfModel:
    """models: those of the test's campaign, whose versions keep the colours of their effects."""
    if model is None:
        return NO_MODEL
    units = measured_units(store, [p.response for p in predicted], [campaign])
    return OfModel(predicted, term_order(models, [model.model]), units, effects_driven(store, [model.model]))


def _chart(
    store: Store,
    about: About,
    chosen: list[Channel],
    model: OfModel,
    given: Mapping[str, str],
    *,
    named: bool = False,
) -> Chart:
    windows = _windows(store, about, chosen, _span(given), given)
    return test_chart(about, chosen, windows, model, named=named or _by_name(given))


def _moving(store: Store, about: About, chosen: list[Channel], given: Mapping[str, str]) -> list[Channel]:
    """Those that the whole test draws: a page that is loaded with a window has the strips of one that is not."""
    strips = [c for c in chosen if not drawn_as_curve(c)]
    if not strips or _by_name(given):
        return chosen
    whole = test_chart(about, strips, _windows(store, about, strips, None, given), NO_MODEL, named=False)
    there = {p.series.name for p in whole.panels if isinstance(p, Strip)}
    return [c for c in chosen if drawn_as_curve(c) or c.name in there]


def _windows(
    store: Store, about: About, chosen: list[Channel], span: tuple[float, float] | None, given: Mapping[str, str]
) -> list[Window]:
    flagged = given.get("flagged") == "1"
    return read_window(store, about.row["campaign"], about.row["test"], chosen, span, flagged=flagged)


def _span(given: Mapping[str, str]) -> tuple[float, float] | None:
    """[s], None for the whole test."""
    from_s, to_s = seconds_in(given, "from"), seconds_in(given, "to")
    return None if from_s is None or to_s is None else (from_s, to_s)


def _by_name(given: Mapping[str, str]) -> bool:
    return given.get("show", "") not in ("", "all")


def _drawn(chart: Chart, chosen: list[Channel]) -> str:
    """The channels that have a curve, as a zoom asks for them again; '' where these are too many for an address."""
    curves = {s.name for p in chart.panels for s in ([p.series] if isinstance(p, Strip) else p.series)}
    names = ",".join(c.name for c in chosen if c.name in curves)
    return names if len(names) < _MOST_ADDRESS else ""


def _neighbours(store: Store, campaign: str, test: str) -> tuple[str | None, str | None]:
    with store.reader() as con:
        names = [
            n for (n,) in con.execute("select test from test where campaign = ? order by rowid", [campaign]).fetchall()
        ]
    at = names.index(test)
    return names[at - 1] if at else None, names[at + 1] if at + 1 < len(names) else None
