"""The fields of a form that was sent."""

from __future__ import annotations

from urllib.parse import parse_qsl

from starlette.requests import Request

from thermodata.errors import UsageError

MOST_BYTES = 2 << 20


async def form_of(request: Request) -> dict[str, str]:
    """Name -> value of an url-encoded body; the last one of a name counts. UsageError beyond MOST_BYTES."""
    body = b""
    async for piece in request.stream():
        body += piece
        if len(body) > MOST_BYTES:
            raise UsageError(
                "this form is too long",
                expected=f"at most {MOST_BYTES >> 20} MiB",
                hint="edit the file itself in an editor, and ingest it again",
            )
    return dict(parse_qsl(body.decode("utf-8", "replace"), keep_blank_values=True))
