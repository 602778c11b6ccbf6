"""A line that a stretch of a test proposes, put into the campaign file: first shown, then written."""

from __future__ import annotations

from pathlib import Path

from starlette.requests import Request
from starlette.responses import Response

from thermodata.draft.writing.put import put
from thermodata.errors import UsageError
from thermodata.schema.files.load import load_campaign
from thermodata.web.desk import Desk
from thermodata.web.form import form_of
from thermodata.web.pages.start import campaign_text, changes, written
from thermodata.web.render import desk_of


async def preview(request: Request) -> Response:
    """POST /rule/preview: campaign, test, line. Nothing is written."""
    form = await form_of(request)
    path, before, after = _proposed(desk_of(request), form)
    return changes(request, path, before, after, form, "/rule/write")


async def write(request: Request) -> Response:
    """POST /rule/write: the same, kept; the file before is kept as campaign.N.yaml."""
    path, before, after = _proposed(desk_of(request), await form_of(request))
    return written(request, path, before, after)


def _proposed(desk: Desk, form: dict[str, str]) -> tuple[Path, str, str]:
    path = campaign_file(desk, form.get("campaign", ""))
    before = campaign_text(path)
    return path, before, put(before, form.get("test", ""), form.get("line", ""))


def campaign_file(desk: Desk, campaign: str) -> Path:
    """The file of a campaign in the chosen folders. UsageError where there is none."""
    found = sorted({p for folder in desk.folders for p in folder.glob("*.yaml")}, key=lambda p: (len(p.name), p.name))
    for path in found:
        try:
            if load_campaign(desk.inside(path)).id == campaign:
                return path
        except UsageError:
            continue  # a model, a file of somebody else, a link that leads out
    raise UsageError(
        f"the file of the campaign '{campaign}' is not here",
        expected=f"a .yaml in {' or '.join(map(str, desk.folders))}",
        hint="put the line into it by hand, and ingest it",
    )
