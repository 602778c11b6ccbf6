"""Scripts and styles, out of the package; nothing comes from elsewhere."""

from __future__ import annotations

from importlib.resources import files
from mimetypes import guess_type

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

SCRIPTS = ("htmx/htmx.min.js", "workbench.js")
STYLES = ("palette.css", "workbench.css")
_OWN = (*SCRIPTS, *STYLES, "htmx/LICENSE", "mark.svg")
_KINDS = {".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}


def serve(request: Request) -> Response:
    """One of the files by its name; any other name is none."""
    name = request.path_params["name"]
    if name not in _OWN:
        raise HTTPException(404)
    body = (files("thermodata.web") / "static" / name).read_bytes()
    kind = next((k for end, k in _KINDS.items() if name.endswith(end)), guess_type(name)[0] or "text/plain")
    # names carry the version: what a browser kept of another one is never used
    return Response(body, media_type=kind, headers={"cache-control": "private, max-age=86400"})
