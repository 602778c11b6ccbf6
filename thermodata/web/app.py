"""The application: routes, and what is said where something goes wrong."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from thermodata.errors import StoreError, ThermodataError
from thermodata.web import assets
from thermodata.web.desk import Desk
from thermodata.web.guard import Guard
from thermodata.web.later import later
from thermodata.web.render import desk_of, page
from thermodata.web.work import Work

# pages, whole
_OF_A_STORE = ("/", "/test", "/quality", "/compare", "/add", "/confirm", "/sql", "/report", "/missing", "/trace")


def application(desk: Desk) -> Starlette:
    """The ASGI application of one workbench."""
    work = Work()

    @asynccontextmanager
    async def life(_: Starlette) -> AsyncIterator[None]:
        yield
        work.close()

    made = Starlette(
        lifespan=life,
        routes=[
            Route("/static/{name:path}", assets.serve, methods=["GET"]),
            Route("/", later("campaign_map.show"), methods=["GET"]),
            Route("/test", later("test.show"), methods=["GET"]),
            Route("/test/data", later("test.data"), methods=["GET"]),
            Route("/test/range", later("test.stretch"), methods=["GET"]),
            Route("/quality", later("quality.show"), methods=["GET"]),
            Route("/compare", later("compare.show"), methods=["GET"]),
            Route("/add", later("adding.show"), methods=["GET"]),
            Route("/confirm", later("confirming.show"), methods=["GET"]),
            Route("/sql", later("sql.show"), methods=["GET"]),
            Route("/sql/{form}", later("sql.take"), methods=["GET"]),
            Route("/report", later("report.show"), methods=["GET"]),
            Route("/report/file", later("report.take"), methods=["GET"]),
            Route("/start", later("start.show"), methods=["GET"]),
            Route("/start/jump", later("jump.show"), methods=["GET"]),
            Route("/start/preview", later("start.preview"), methods=["POST"]),
            Route("/start/write", later("start.write"), methods=["POST"]),
            Route("/start/model", later("start.model"), methods=["POST"]),
            Route("/rule/preview", later("rule.preview"), methods=["POST"]),
            Route("/rule/write", later("rule.write"), methods=["POST"]),
            Route("/missing", later("missing.show"), methods=["GET"]),
            Route("/task/{task}", later("working.start"), methods=["POST"]),
            Route("/task/{task}", later("working.watch"), methods=["GET"]),
            Route("/task/{task}/cancel", later("working.cancel"), methods=["POST"]),
            Route("/trace", later("trace.show"), methods=["GET"]),
        ],
        middleware=[Middleware(Guard, desk=desk)],
        exception_handlers={ThermodataError: _refused, HTTPException: _no_page},
    )
    made.state.desk, made.state.work = desk, work
    return made


def _refused(request: Request, error: Exception) -> Response:
    """What a terminal would say after 'error:', as a page."""
    assert isinstance(error, ThermodataError)
    if not desk_of(request).has_store and request.url.path in _OF_A_STORE:
        # what is asked before there is anything to show leads on to it: the user may have no terminal
        return page(request, "no_store.html.j2", title="No store yet", command="thermodata init FOLDER")
    status = 503 if isinstance(error, StoreError) else 400
    # within a page stands what is refused alone, or a page would stand in the page
    template = "refused_part.html.j2" if request.headers.get("hx-request") else "refused.html.j2"
    return page(request, template, title="This can't be done", command="", status=status, error=error)


def _no_page(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    return page(request, "no_page.html.j2", title="There is no such page", command="", status=error.status_code)
