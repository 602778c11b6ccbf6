"""The application: routes, and what is said where something goes wrong."""

from __future__ import annotations

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
from thermodata.web.pages import campaign_map, test
from thermodata.web.render import page


def application(desk: Desk) -> Starlette:
    """The ASGI application of one workbench."""
    made = Starlette(
        routes=[
            Route("/static/{name:path}", assets.serve, methods=["GET"]),
            Route("/", campaign_map.show, methods=["GET"]),
            Route("/test", test.show, methods=["GET"]),
            Route("/test/data", test.data, methods=["GET"]),
            Route("/test/range", test.stretch, methods=["GET"]),
            Route("/trace", test.way_back, methods=["GET"]),
        ],
        middleware=[Middleware(Guard, desk=desk)],
        exception_handlers={ThermodataError: _refused, HTTPException: _no_page},
    )
    made.state.desk = desk
    return made


def _refused(request: Request, error: Exception) -> Response:
    """What a terminal would say after 'error:', as a page."""
    assert isinstance(error, ThermodataError)
    status = 503 if isinstance(error, StoreError) else 400
    return page(request, "refused.html.j2", title="This can't be done", command="", status=status, error=error)


def _no_page(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    return page(request, "no_page.html.j2", title="There is no such page", command="", status=error.status_code)
