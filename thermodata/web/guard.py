"""Who is let in: this machine's browser that opened the address which the terminal printed, and nobody else.

Every request passes here before any page sees it. A page of another origin can make a browser send requests to
127.0.0.1, and by DNS rebinding under a name of its own: so Host must be our address exactly, reading needs a cookie
that is never sent along from elsewhere, and writing needs Origin and a token that only our pages hold.
"""

from __future__ import annotations

from html import escape
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import HTMLResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from thermodata.web.desk import Desk, same

TOKEN_HEADER = "x-thermodata-token"
TICKET_PATH = "/open"
_READING = ("GET", "HEAD")
_OWN_FETCHES = ("same-origin", "none")  # our own pages; an address that was typed, a bookmark
_HEADERS = {
    "content-security-policy": "default-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'; "
    "object-src 'none'",
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), microphone=(), geolocation=()",
}


class Guard:
    """ASGI middleware around the whole application."""

    def __init__(self, app: ASGIApp, desk: Desk) -> None:
        self.app, self.desk = app, desk
        # a browser sends cookies to every port of a host: each workbench has its own name for its
        self.cookie = f"thermodata_{desk.port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        if scope["type"] != "http":  # no page opens a socket
            return

        async def sealed(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in _HEADERS.items():
                    headers[name] = value
                headers.setdefault("cache-control", "no-store")
            await send(message)

        answer = self._answer(scope)
        await (self.app if answer is None else answer)(scope, receive, sealed)

    def _answer(self, scope: Scope) -> Response | None:
        """The refusal, or the answer to a ticket; None where the application is to answer."""
        headers = Headers(scope=scope)
        if headers.getlist("host") != [self.desk.host]:
            return _refusal(421, "This is not the address of this workbench", f"It is {self.desk.address}.")
        method = scope["method"]
        # a browser says where a request comes from; SameSite knows no ports, so a page that another program of this
        # machine serves is of our site, and its requests carry our cookie
        if scope["path"] != TICKET_PATH and any(f not in _OWN_FETCHES for f in headers.getlist("sec-fetch-site")):
            return _refusal(403, "This was not sent by a page of this workbench", "A page of another address sent it.")
        if scope["path"] == TICKET_PATH and method == "GET":
            return self._open(scope, headers)
        if not self._has_cookie(headers):
            return _refusal(
                403,
                "This browser has not opened the workbench",
                "Open the address that the terminal printed. It works once; start the workbench again for another.",
            )
        if method in _READING:
            return None
        if method != "POST":
            return _refusal(405, "This is not done here", "Pages are read with GET and changed with POST.")
        if headers.getlist("origin") != [self.desk.address]:
            return _refusal(403, "This was not sent by a page of this workbench", "Its Origin is another one.")
        if not same(headers.get(TOKEN_HEADER, ""), self.desk.keys.form):
            return _refusal(403, "This was not sent by a page of this workbench", "Its token is missing or wrong.")
        if not self.desk.write:
            return _refusal(
                403,
                "This workbench only reads",
                "End it, and start it again with: thermodata workbench --write",
            )
        return None

    def _has_cookie(self, headers: Headers) -> bool:
        for line in headers.getlist("cookie"):
            try:
                cookies = SimpleCookie(line)
            except CookieError:
                continue
            if self.cookie in cookies and same(cookies[self.cookie].value, self.desk.keys.session):
                return True
        return False

    def _open(self, scope: Scope, headers: Headers) -> Response:
        ticket = parse_qs(scope["query_string"].decode("latin-1")).get("ticket", [""])[0]
        if not self.desk.keys.spend(ticket):
            if self._has_cookie(headers):  # the same browser went back
                return _onward()
            return _refusal(
                403,
                "This address was opened before",
                "It works once. Start the workbench again for another.",
            )
        answer = _onward()
        answer.set_cookie(self.cookie, self.desk.keys.session, path="/", httponly=True, samesite="strict")
        return answer


def _onward() -> HTMLResponse:
    # a redirect would still count as a step from elsewhere, on which a Strict cookie is not sent
    return HTMLResponse(
        '<!doctype html><html lang="en"><head><meta charset="utf-8"><title>thermodata</title>'
        '<link rel="icon" href="/static/mark.svg">'
        '<meta http-equiv="refresh" content="0;url=/"></head><body><p><a href="/">Open the workbench</a></p>'
        "</body></html>"
    )


def _refusal(status: int, what: str, todo: str) -> HTMLResponse:
    return HTMLResponse(
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(what)}</title></head>'
        f"<body><h1>{escape(what)}</h1><p>{escape(todo)}</p></body></html>",
        status_code=status,
    )
