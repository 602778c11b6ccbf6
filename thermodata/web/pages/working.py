"""Starts, watches and cancels long work."""

from __future__ import annotations

from pathlib import Path

from starlette.requests import Request
from starlette.responses import Response

from thermodata.errors import UsageError, unknown_name
from thermodata.schema.words.sentences import listed
from thermodata.web.form import form_of
from thermodata.web.render import desk_of, page
from thermodata.web.work import Job, Work

# task -> (its fields, what it does in words)
STARTED = {
    "draft": (("folder",), "Looking at every file"),
    "diagnose": (("model",), "Asking every candidate"),
    "add": (("model", "candidate"), "Adding {candidate}"),
    "confirm": (("model", "candidate"), "Asking the locked tests of {candidate}"),
    "fit": (("path",), "Fitting {path}"),
    "ingest": (("campaign",), "Reading the files of {campaign}"),
    "report": (("model", "out"), "Writing the report"),
}
_PATHS = ("path", "campaign", "out", "folder")


async def start(request: Request) -> Response:
    """POST /task/TASK with its fields."""
    task = request.path_params["task"]
    if task not in STARTED:
        raise unknown_name("work", task, list(STARTED))
    names, what = STARTED[task]
    form = await form_of(request)
    given = {name: form.get(name, "") for name in names}
    for name, value in given.items():
        if not value:
            raise UsageError(f"'{name}' is missing", where=task)
    desk = desk_of(request)
    arguments = {n: str(desk.inside(v)) if n in _PATHS else v for n, v in given.items()}
    told = {n: Path(v).name or v if n in _PATHS else listed(v.splitlines()) for n, v in given.items()}
    return _shown(request, work_of(request).start(task, what.format(**told), desk.store_path, arguments))


async def watch(request: Request) -> Response:
    """GET /task/ID: how far it is; when it is done, the browser goes on to the result, or what it told is shown."""
    return _shown(request, work_of(request).job(request.path_params["task"]))


async def cancel(request: Request) -> Response:
    """POST /task/ID/cancel."""
    return _shown(request, work_of(request).cancel(request.path_params["task"]))


def work_of(request: Request) -> Work:
    work: Work = request.app.state.work
    return work


def _shown(request: Request, job: Job) -> Response:
    # of what told something that is to be read, nobody is led away; a part that is shown asks no more, so the browser
    # is sent on once, however long the next page takes
    onward = job.onward if job.state == "done" and "told" not in job.result else ""
    return page(request, "task.html.j2", title="", command="", job=job, onward=onward)
