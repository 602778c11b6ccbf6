"""Asks an ASGI application without a port: what was sent is exactly what a test says, header by header."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any
from urllib.parse import unquote, urlencode

Header = tuple[str, str]


@dataclass(frozen=True)
class Answer:
    """headers: as they were sent, names in small letters."""

    status: int
    headers: list[Header]
    body: bytes

    @property
    def text(self) -> str:
        return self.body.decode()

    def header(self, name: str) -> str | None:
        return next((v for k, v in self.headers if k == name), None)


@dataclass
class Client:
    """headers: sent with every request."""

    app: Any
    headers: Sequence[Header] = ()

    def get(self, url: str, headers: Sequence[Header] = (), method: str = "GET") -> Answer:
        return self.ask(method, url, headers)

    def post(self, url: str, form: dict[str, str] | None = None, headers: Sequence[Header] = ()) -> Answer:
        kind = ("content-type", "application/x-www-form-urlencoded")
        return self.ask("POST", url, [kind, *headers], urlencode(form or {}).encode())

    def ask(self, method: str, url: str, headers: Sequence[Header], body: bytes = b"") -> Answer:
        """One request and all of its answer."""
        path, _, query = url.partition("?")
        scope = {
            "type": "http",
            "asgi": {"version": "3.0"},
            "http_version": "1.1",
            "method": method,
            "scheme": "http",
            "path": unquote(path),
            "raw_path": path.encode(),
            "query_string": query.encode(),
            "root_path": "",
            "headers": [(k.encode(), v.encode("latin-1")) for k, v in (*self.headers, *headers)],
            "server": ("127.0.0.1", 8000),
            "client": ("127.0.0.1", 50000),
            "state": {},
        }
        sent: list[dict[str, Any]] = []
        asked = [{"type": "http.request", "body": body, "more_body": False}]

        async def receive() -> dict[str, Any]:
            if not asked:
                await asyncio.Event().wait()  # a browser that stays
            return asked.pop()

        async def send(message: dict[str, Any]) -> None:
            sent.append(message)

        asyncio.run(self.app(scope, receive, send))
        start = next(m for m in sent if m["type"] == "http.response.start")
        return Answer(
            start["status"],
            [(k.decode(), v.decode("latin-1")) for k, v in start["headers"]],
            b"".join(m.get("body", b"") for m in sent if m["type"] == "http.response.body"),
        )
