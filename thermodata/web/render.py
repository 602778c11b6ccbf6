"""Templates to pages. Every page is told which command does the same."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from functools import cache
from typing import Any
from urllib.parse import urlencode

import jinja2
from starlette.requests import Request
from starlette.responses import HTMLResponse

from thermodata.report.text.clauses import clauses
from thermodata.report.text.fit import span
from thermodata.report.verdict.verdict import probability
from thermodata.report.words.glossary import FITTED_TOO, LEVEL_SENTENCE
from thermodata.report.words.numbers import base_role, change, clock, duration, number, percent, typeset
from thermodata.schema.words.sentences import with_count
from thermodata.version import __version__
from thermodata.view.lists.models import of_several_campaigns
from thermodata.web.assets import SCRIPTS, STYLES
from thermodata.web.desk import Desk

# (path, title), in the order of the work
PAGES = (
    ("/start", "Start"),
    ("/", "Tests"),
    ("/quality", "Quality"),
    ("/compare", "Compare"),
    ("/missing", "What is missing"),
    ("/sql", "SQL"),
    ("/report", "Report"),
)


@cache
def environment() -> jinja2.Environment:
    """Everything from data is escaped; a name that a template misspells is an error."""
    made = jinja2.Environment(
        loader=jinja2.PackageLoader("thermodata.web"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    made.filters.update(
        number=lambda value, digits=3: typeset(number(value, digits)),
        span=lambda result, name: typeset(span(result, name)),
        signed=lambda value: f"{'+' if value > 0 else ''}{number(value)}",
        plain_number=plain_number,
        ends=ends,
        moment=lambda iso: re.sub(r"\.?0*Z$", "", str(iso)).replace("T", " ") + " UTC",
        duration=duration,
        clock=clock,
        typeset=typeset,
        clauses=clauses,
        probability=probability,
        begun=begun,
        percent=lambda share: typeset(percent(share)),
        base_role=base_role,
        of_several_campaigns=of_several_campaigns,
        with_count=with_count,
        plain=lambda text: str(text).replace("_", " "),
        grouped=lambda n: f"{n:,}".replace(",", "\u202f"),
    )
    made.globals.update(link=link, version=__version__, change=change, level=LEVEL_SENTENCE, fitted_too=FITTED_TOO)
    return made


def desk_of(request: Request) -> Desk:
    desk: Desk = request.app.state.desk
    return desk


def begun(sentence: str) -> str:
    """A sentence with a capital, but where it begins with the name of an effect or a channel: table_bearing:Pt11."""
    name = re.match(r"\S*[_:.\d]\S", sentence)
    return sentence if name else sentence[:1].upper() + sentence[1:]


def plain_number(value: float, digits: int = 3) -> str:
    """A number without zeros that say nothing, for counts, shares and limits: '2', '0.4', '0.005'; '–' for none."""
    text = number(value, digits)
    whole, point, rest = text.partition(".")
    return typeset(whole + (point + rest).rstrip("0").rstrip(".") if point and "e" not in rest else text)


def ends(low: float, high: float) -> str:
    """'(−0.69 … +0.02)': both ends of an interval in as many decimals as two digits of its width have."""
    digits = max(0, 1 - math.floor(math.log10(high - low))) if high > low else 2
    low, high = (round(end, digits) + 0.0 for end in (low, high))  # -0.0 is 0
    return typeset(f"({_signed(low, digits)} … {_signed(high, digits)})")


def _signed(value: float, digits: int) -> str:
    return f"{value:+.{digits}f}" if value else f"{0:.{digits}f}"


def link(path: str, /, **state: Any) -> str:
    """A page with its state; what is empty is left out."""
    kept = [(k, v) for k, v in state.items() if v not in (None, "", ())]
    query = urlencode(kept, doseq=True)
    return f"{path}?{query}" if query else path


def page(
    request: Request,
    template: str,
    *,
    title: str,
    command: str,
    status: int = 200,
    headers: Mapping[str, str] | None = None,
    **context: Any,
) -> HTMLResponse:
    """A whole page, or a part of one where the template is a part. command: that does the same in a terminal."""
    desk = desk_of(request)
    text = (
        environment()
        .get_template(template)
        .render(
            title=title,
            command=command,
            desk=desk,
            here=request.url.path,
            pages=PAGES,
            # a refusal leads on without what was refused
            query={"model": "", **(request.query_params if status < 400 else {})},
            styles=STYLES,
            scripts=SCRIPTS,
            **context,
        )
    )
    return HTMLResponse(text, status_code=status, headers=dict(headers or {}))
