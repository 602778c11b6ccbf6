"""From a folder of raw logs to a store: the draft, its questions as a form, the changed lines, and the ingest."""

from __future__ import annotations

import contextlib
import difflib
import itertools
import os
import re
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import Response

from thermodata.draft.make import first_model, modelled, write_answered
from thermodata.draft.writing.baseline import responses_of
from thermodata.draft.writing.fill_in import filled_in
from thermodata.draft.writing.own_id import taken_by_another
from thermodata.draft.writing.questions import questions
from thermodata.errors import SpecError, UsageError
from thermodata.schema.files.campaign import Channel
from thermodata.schema.files.load import parse_campaign
from thermodata.store.catalogue.campaign_paths import campaign_paths
from thermodata.store.catalogue.format.create import CATALOGUE
from thermodata.store.ingest.told.declared.unanswered import unknown_places
from thermodata.web.command import command
from thermodata.web.desk import Desk
from thermodata.web.form import form_of
from thermodata.web.pages.parts.start_form import answered, form_state
from thermodata.web.render import desk_of, page

_MOST_BYTES = 4 << 20
_PLACE = re.compile(r"^@@ -\S+ \+(\d+)(?:,\d+)? @@$")
_MOST_MODELS = 5
_MOST_FOLDERS, _MOST_LOOKED_AT = 100, 1_000


def show(request: Request) -> Response:
    """GET /start: file (a campaign file in a chosen folder)."""
    desk = desk_of(request)
    folder = desk.folders[0]
    path = desk.inside(request.query_params.get("file") or "campaign.yaml")
    text = campaign_text(path) if path.is_file() else None
    return page(
        request,
        "start.html.j2",
        title="Start",
        command=command(desk.store_path, *(("init", folder) if text is None else ("ingest", path))),
        folder=folder,
        within=[own for own in desk.folders if own != desk.store_path.resolve()] or [folder],
        below=_below(folder),
        draft_command=command(desk.store_path, "init", folder),
        elsewhere_command=command(desk.store_path, "workbench", "FOLDER", "--write"),
        there=text is not None,
        stored=[] if text is not None or not desk.has_store else _stored(desk),
        id_taken=None if text is None else _id_taken(desk, path, text),
        **form_state(path, text),
        **_first_model(desk, path, text),
    )


def _below(folder: Path) -> list[str]:
    """Folders right below it that are no store and have no campaign file yet, for a field that takes any."""
    found = []
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        for entry in itertools.islice(entries, _MOST_LOOKED_AT):
            own = Path(entry.path)
            is_folder = not entry.name.startswith(".") and entry.is_dir()
            if is_folder and not (own / CATALOGUE).exists() and not (own / "campaign.yaml").exists():
                found.append(entry.path)
    return sorted(found)[:_MOST_FOLDERS]


def _stored(desk: Desk) -> list[tuple[str, str, str | None]]:
    """(campaign, its machines, its file as the address of this page has it; None where it lies in no chosen folder, or
    is gone)."""
    with desk.store().reader() as con:
        rows = con.execute(
            "select c.campaign, string_agg(distinct m.machine, ', ' order by m.machine), c.path "
            "from campaign c left join machine m on m.campaign = c.campaign group by c.campaign, c.path order by 1"
        ).fetchall()
    found = []
    for name, machines, written in rows:
        path = Path(written) if written else None
        near = path is not None and path.is_file() and any(path.resolve().is_relative_to(f) for f in desk.folders)
        found.append((name, machines or "", str(path) if near else None))
    return found


def _id_taken(desk: Desk, path: Path, text: str) -> tuple[str, str, str] | None:
    """(the id of a campaign file, the one that its folder would have given it, the file of the campaign of the store
    that has that one); None where the draft got the id of its folder, or its user wrote another."""
    with contextlib.suppress(SpecError):
        name = parse_campaign(text, path.name).id
        taken = taken_by_another(path.parent, name, campaign_paths(desk.store_path))
        return None if taken is None else (name, *taken)
    return None


async def model(request: Request) -> Response:
    """POST /start/model: drafts model.yaml for a displacement of the user's choice."""
    desk, form = desk_of(request), await form_of(request)
    path = desk.inside(form.get("file", ""))
    text = campaign_text(path)
    made = first_model(path, form.get("response") or None)
    instead = f" in place of the draft for {made.replaced}" if made.replaced else ""
    told = f"{made.model.name} is drafted for {made.response}{instead}."
    if made.kept is not None:
        told += f" The one that was there is kept as {made.kept.name}."
    state = _first_model(desk, path, text)
    return page(request, "start_model.html.j2", title="", command="", path=path, **{**state, "told": told})


def _first_model(desk: Desk, path: Path, text: str | None) -> dict[str, Any]:
    """What the section of the first model shows; oob: whether it takes the place of the one that is there. A campaign
    file that does not load offers no displacement: what is wrong with it is said where its questions are answered."""
    responses: list[tuple[str, str]] = []
    chosen = None
    with contextlib.suppress(SpecError):
        if text is not None:
            campaign = parse_campaign(text, path.name)
            responses = [(name, _where(campaign.channels[name])) for name in responses_of(campaign)]
            chosen = modelled(path)
    return {
        "models": _models(path.parent),
        "responses": responses,
        "modelled": chosen,
        "model_command": command(desk.store_path, "first-model", path, "--response", chosen or "CHANNEL"),
        "told": "",
        "oob": False,
    }


def _where(channel: Channel) -> str:
    """'axis Y, at tcp'."""
    return ", ".join(filter(None, (channel.axis and f"axis {channel.axis}", channel.at and f"at {channel.at}")))


def _models(folder: Path) -> list[tuple[str, str]]:
    """(name, text) of the model files beside the campaign file."""
    found = sorted(p for p in folder.glob("model*.yaml") if p.stat().st_size <= _MOST_BYTES)
    return [(p.name, p.read_text(encoding="utf-8", errors="replace")) for p in found[:_MOST_MODELS]]


async def preview(request: Request) -> Response:
    """POST /start/preview: the lines that the answers change; nothing is written."""
    desk, form = desk_of(request), await form_of(request)
    path = desk.inside(form.get("file", ""))
    before = campaign_text(path)
    after = filled_in(before, answered(form, questions(before)))
    return changes(request, path, before, after, form, "/start/write")


async def write(request: Request) -> Response:
    """POST /start/write: the answers go into the file; the one before is kept as campaign.N.yaml."""
    desk, form = desk_of(request), await form_of(request)
    path = desk.inside(form.get("file", ""))
    before = campaign_text(path)
    after = filled_in(before, answered(form, questions(before)))
    kept, followed = _kept(path, before, after)
    # what stands above and below follows: the questions, how many there are, and the model
    state = {**form_state(path, after), **_first_model(desk, path, after), "oob": True}
    return page(request, "start_renewed.html.j2", title="", command="", kept=kept, followed=followed, **state)


def changes(request: Request, path: Path, before: str, after: str, form: dict[str, str], onward: str) -> Response:
    """What would be written, as the lines that change. onward: where the form goes when they are wanted."""
    lines = list(difflib.unified_diff(before.splitlines(), after.splitlines(), "before", "after", lineterm="", n=0))
    known = unknown_places(parse_campaign(before))
    return page(
        request,
        "start_diff.html.j2",
        title="",
        command="",
        path=path,
        lines=[_PLACE.sub(r"line \1", line) for line in lines[2:]],
        doubts=[said for said in unknown_places(parse_campaign(after)) if said not in known],
        form=form,
        changed=before != after,
        onward=onward,
    )


def written(request: Request, path: Path, before: str, after: str) -> Response:
    """Writes it, and says what comes next."""
    kept, followed = _kept(path, before, after)
    return page(request, "start_written.html.j2", title="", command="", path=path, kept=kept, followed=followed)


def _kept(path: Path, before: str, after: str) -> tuple[Path | None, bool]:
    """(where the file before is, whether the first model followed)."""
    return write_answered(path, after) if after != before else (None, False)


def campaign_text(path: Path) -> str:
    """UsageError for what is no campaign file, too long a one, or one in another encoding: it is written back."""
    if not path.is_file() or path.suffix not in (".yaml", ".yml"):
        raise UsageError(
            "there is no such campaign file", where=str(path), hint="draft one first: thermodata init FOLDER"
        )
    if path.stat().st_size > _MOST_BYTES:
        raise UsageError("this campaign file is too long for a form", where=str(path), hint="edit it by hand")
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise UsageError(
            "this campaign file is not in UTF-8",
            where=str(path),
            got=f"byte 0x{error.object[error.start]:02x} at place {error.start}",
            hint="save it as UTF-8",
        ) from error
