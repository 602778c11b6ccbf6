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
from thermodata.web.pages import adding, campaign_map, compare, jump, missing, report, sql, start, test, working
from thermodata.web.render import page
from thermodata.web.work import Work


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
            Route("/", campaign_map.show, methods=["GET"]),
            Route("/test", test.show, methods=["GET"]),
            Route("/test/data", test.data, methods=["GET"]),
            Route("/test/range", test.stretch, methods=["GET"]),
            Route("/compare", compare.show, methods=["GET"]),
            Route("/add", adding.show, methods=["GET"]),
            Route("/sql", sql.show, methods=["GET"]),
            Route("/sql/{form}", sql.take, methods=["GET"]),
            Route("/report", report.show, methods=["GET"]),
            Route("/report/file", report.take, methods=["GET"]),
            Route("/start", start.show, methods=["GET"]),
            Route("/start/jump", jump.show, methods=["GET"]),
            Route("/start/preview", start.preview, methods=["POST"]),
            Route("/start/write", start.write, methods=["POST"]),
            Route("/missing", missing.show, methods=["GET"]),
            Route("/task/{task}", working.start, methods=["POST"]),
            Route("/task/{task}", working.watch, methods=["GET"]),
            Route("/task/{task}/cancel", working.cancel, methods=["POST"]),
            Route("/trace", test.way_back, methods=["GET"]),
        ],
        middleware=[Middleware(Guard, desk=desk)],
        exception_handlers={ThermodataError: _refused, HTTPException: _no_page},
    )
    made.state.desk, made.state.work = desk, work
    return made


def _refused(request: Request, error: Exception) -> Response:
    """What a terminal would say after 'error:', as a page."""
    assert isinstance(error, ThermodataError)
    status = 503 if isinstance(error, StoreError) else 400
    return page(request, "refused.html.j2", title="This can't be done", command="", status=status, error=error)


def _no_page(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    return page(request, "no_page.html.j2", title="There is no such page", command="", status=error.status_code)
