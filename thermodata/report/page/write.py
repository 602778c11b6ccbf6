"""Pages on disk: one file that needs nothing beside it, and may ask nobody for anything."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

from thermodata.chart import Chart, HeatMap, script, script_json, style
from thermodata.store.base.files import plain_name, whole_file
from thermodata.version import __version__


def page_name(name: str, model: str) -> str:
    """The file of a report. name: of the model, which may hold anything; model: its id, which tells files apart."""
    # short: a file's name may have 255 bytes, and a letter up to four
    return f"report-{plain_name(name)[:50]}-{model[:8]}.html"


def write_page(out: Path | str, html: str) -> Path:
    """The page's path; a cut write leaves no half page."""
    target = Path(out)
    with whole_file(target) as part:
        part.write_text(html, encoding="utf-8")
    return target


def page_values(figures: Mapping[str, Chart | HeatMap]) -> dict[str, Any]:
    """What every page's template needs: styles, scripts, figures as JSON, and the policy that allows just these."""
    from markupsafe import Markup

    from thermodata.report.charts.figures import height_of

    own = files("thermodata.report.page")
    css = style() + (own / "page.css").read_text(encoding="utf-8")
    js = script() + "\n" + (own / "page.js").read_text(encoding="utf-8")
    return {
        "css": Markup(css),
        "js": Markup(js),
        "policy": policy(css, js),
        "json": {key: Markup(script_json(figure.as_json(coarse=True))) for key, figure in figures.items()},
        "heights": {key: height_of(figure) for key, figure in figures.items()},
        "version": __version__,
    }


def policy(css: str, js: str) -> str:
    """A content security policy under which nothing but these two texts runs, and nothing is loaded or sent."""
    style_hash, script_hash = (base64.b64encode(hashlib.sha256(t.encode()).digest()).decode() for t in (css, js))
    return (
        f"default-src 'none'; script-src 'sha256-{script_hash}'; style-src 'sha256-{style_hash}'; "
        "base-uri 'none'; form-action 'none'"
    )
