"""The script and the styles of all charts, as files to serve or as one text to put into a page."""

from __future__ import annotations

import re
from importlib.resources import files

from thermodata.errors import unknown_name

SCRIPTS = (
    "language.js",
    "uplot/uPlot.iife.min.js",
    "data.js",
    "paint.js",
    "readout.js",
    "chart.js",
    "heatmap.js",
    "mount.js",
)
"""In the order in which a page has to load them."""
# a comment behind code stands far to the right of it, and no text holds two slashes after spaces
_TAIL = re.compile(r"\s{2,}//\s.*$")
STYLES = ("uplot/uPlot.min.css", "palette.css", "chart.css")


def asset(name: str) -> str:
    """The text of one of SCRIPTS, STYLES or 'uplot/LICENSE'; any other name is refused."""
    known = (*SCRIPTS, *STYLES, "uplot/LICENSE")
    if name not in known:
        raise unknown_name("file of the charts", name, known)
    return (files("thermodata.chart") / "static" / name).read_text(encoding="utf-8")


def script() -> str:
    """All scripts as one; needs no other, no eval, no network, and adds only `ThermoChart` and `uPlot` to a page.

    Our own without comments and indentation, which every saved page would carry: none has a text of several lines.
    """
    return "\n".join(asset(name) if "/" in name else _without_comments(asset(name)) for name in SCRIPTS)


def _without_comments(text: str) -> str:
    lines = (_TAIL.sub("", line).strip() for line in text.splitlines())
    return "\n".join(line for line in lines if line and not line.startswith("//"))


def style() -> str:
    """All styles as one; colours are custom properties, light and dark."""
    return "\n".join(asset(name) for name in STYLES)
