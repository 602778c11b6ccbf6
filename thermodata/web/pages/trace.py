"""From a point of a curve back to the row of the file that it came from."""

from __future__ import annotations

from typing import Any

from starlette.requests import Request
from starlette.responses import Response

from thermodata.report.text.straight_line import offset_of, sum_of
from thermodata.report.words.numbers import typeset
from thermodata.store.trace.lineage import trace
from thermodata.web.command import command
from thermodata.web.query import seconds_in
from thermodata.web.render import desk_of, page


def show(request: Request) -> Response:
    """GET /trace: one sample of a channel, back to the row of the file that it came from."""
    desk, given = desk_of(request), request.query_params
    campaign, test = given.get("campaign", ""), given.get("test", "")
    channel, at_s = given.get("channel", ""), seconds_in(given, "at")
    found = trace(desk.store(), campaign, test, channel or None, t_s=at_s)
    words = ["trace", campaign, test, *([channel] if channel else [])]
    words += ["--at", f"{at_s:.15g} s"] if at_s is not None else []
    return page(
        request,
        "trace.html.j2",
        title=f"Where {channel or test} comes from",
        section="/",
        command=command(desk.store_path, *words, "--verify"),
        found=found,
        plateaus=plateaus(found),
        total=typeset(sum_of(found).replace("*", "×")) if found.get("sample") else "",
        calibrations=[{**step, "offset": _offset(step)} for step in found.get("calibrations", ())],
        campaign=campaign,
        test=test,
        channel=channel,
        at_s=at_s,
    )


def _offset(step: dict[str, Any]) -> str:
    """In as many digits as the gain beside it."""
    offset = step.get("offset_value")
    return typeset(offset_of({**step, "offset_value": offset and float(f"{offset:.6g}")}))


def plateaus(found: dict[str, Any]) -> list[tuple[str, list[dict[str, Any]]]]:
    """(calibration, the rows of its jump test a plateau) of the channel, and of those that it is derived from."""
    own = [(step["calibration"], step["rows"]) for step in found.get("calibrations", ()) if step["rows"]]
    return own + [one for operand in found.get("operands", ()) for one in plateaus(operand)]
