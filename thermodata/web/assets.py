"""Scripts and styles, out of the package; nothing comes from elsewhere."""

from __future__ import annotations

from importlib.resources import files
from mimetypes import guess_type

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from thermodata.chart import assets as chart

SCRIPTS = ("htmx/htmx.min.js", "chart.js", "workbench.js")
STYLES = ("chart.css", "workbench.css")
_OWN = ("htmx/htmx.min.js", "workbench.js", "workbench.css", "htmx/LICENSE", "mark.svg")
# of the charts, all parts as one: the report puts the same into its pages
_CHARTS = {"chart.js": chart.script, "chart.css": chart.style}
_KINDS = {".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}


def serve(request: Request) -> Response:
    """One of the files by its name; any other name is none."""
    name = request.path_params["name"]
    if name in _CHARTS:
        body = _CHARTS[name]().encode()
    elif name in _OWN:
        body = (files("thermodata.web") / "static" / name).read_bytes()
    else:
        raise HTTPException(404)
    kind = next((k for end, k in _KINDS.items() if name.endswith(end)), guess_type(name)[0] or "text/plain")
    # names carry the version: what a browser kept of another one is never used
    return Response(body, media_type=kind, headers={"cache-control": "private, max-age=86400"})
