"""The report: one static file of a model, written into a chosen folder and taken from there."""

from __future__ import annotations

from starlette.requests import Request
from starlette.responses import FileResponse, Response

from thermodata.errors import UsageError
from thermodata.report.page.write import page_name
from thermodata.view.lists.models import model_rows
from thermodata.web.chosen import model_in
from thermodata.web.command import command
from thermodata.web.render import desk_of, page


def show(request: Request) -> Response:
    """GET /report: model."""
    desk = desk_of(request)
    store = desk.store()
    models = model_rows(store)
    model = model_in(store, models, request.query_params.get("model"))
    out = page_name(model.name, model.model) if model else ""
    return page(
        request,
        "report.html.j2",
        title="Report",
        command=command(desk.store_path, "report", model.model, "--out", out) if model else "thermodata fit model.yaml",
        models=models,
        model=model,
        out=out,
        there=bool(out) and (desk.folders[0] / out).is_file(),
        folder=desk.folders[0],
    )


def take(request: Request) -> Response:
    """GET /report/file: name. As a download only: a page of the report's own scripts is no page of the workbench."""
    name = request.query_params.get("name", "")
    path = desk_of(request).inside(name)
    if path.suffix != ".html" or not path.name.startswith("report-") or not path.is_file():
        raise UsageError("there is no such report", where=name, hint="write it first")
    return FileResponse(path, filename=path.name, media_type="text/html")
