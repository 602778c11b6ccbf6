"""Pages whose code is loaded when they are first asked for: the first one must not wait for what the others need."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from importlib import import_module
from inspect import iscoroutinefunction
from typing import Any

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response


def later(name: str) -> Callable[[Request], Awaitable[Response]]:
    """The page 'MODULE.FUNCTION' of `thermodata.web.pages`."""

    async def page(request: Request) -> Response:
        found = await run_in_threadpool(page_named, name)
        if iscoroutinefunction(found):
            answer: Response = await found(request)
            return answer
        return await run_in_threadpool(found, request)

    page.__name__ = name
    return page


def page_named(name: str) -> Callable[[Request], Any]:
    """The function itself, loaded."""
    module, _, function = name.partition(".")
    found: Callable[[Request], Any] = getattr(import_module(f"thermodata.web.pages.{module}"), function)
    return found
