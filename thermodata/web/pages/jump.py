"""A jump test as it was logged, each step with a place for the move that was commanded."""

from __future__ import annotations

from starlette.requests import Request
from starlette.responses import Response

from thermodata.chart.pack import script_json
from thermodata.chart.parts import Axis, Panel, Series, Span
from thermodata.chart.spec import Chart
from thermodata.draft.probes.jump_seen import JumpSeen, jump_seen
from thermodata.draft.writing.questions import questions
from thermodata.errors import UsageError
from thermodata.schema.words.sentences import counted
from thermodata.web.render import desk_of, page


def show(request: Request) -> Response:
    """GET /start/jump: file, calibration. Reads the one file, and says why where it can't be drawn."""
    desk, given = desk_of(request), request.query_params
    path = desk.inside(given.get("file", ""))
    name = given.get("calibration", "")
    if not path.is_file():
        raise UsageError(
            "there is no such campaign file",
            where=str(path),
            hint="choose the file anew on the first page: it may have been moved or renamed",
        )
    asked = next((q for q in questions(path.read_text("utf-8")) if q.kind == "moves" and q.about == name), None)
    if asked is None:
        raise UsageError(
            f"no question for the jump test '{name}'",
            hint="the file was changed meanwhile: load the page again",
        )
    why, seen = "", None
    try:
        seen = jump_seen(path, name, desk.inside)
    except UsageError as error:
        why = " ".join(str(error).split())
    moves = [m.strip() for m in asked.value.strip("[] ").split(",") if m.strip()]
    steps = seen.steps if seen else ()
    return page(
        request,
        "start_jump.html.j2",
        title="",
        command="",
        q=asked,
        seen=seen,
        why=why,
        moves=moves if len(moves) == len(steps) else [""] * len(steps),
        written=moves,
        chart=script_json(_chart(seen).as_json()) if seen else "",
    )


def _chart(seen: JumpSeen) -> Chart:
    unit = seen.unit or "V"
    ends = [*(s.from_s for s in seen.steps[1:]), float(seen.t_s[-1])]
    spans = [
        Span(s.to_s, end, "phase", f"{i}", f"after step {i}: {s.size:+.4g} {unit}")
        for i, (s, end) in enumerate(zip(seen.steps, ends, strict=True), 1)
    ]
    panel = Panel(seen.signal, unit, [Series(seen.signal, unit, seen.values, "measured", label="")], height=190)
    about = f"{seen.signal} in {seen.file}: {counted(len(seen.steps), 'step')}"
    return Chart(about, Axis("time", "s"), seen.t_s, [panel], spans=spans)
