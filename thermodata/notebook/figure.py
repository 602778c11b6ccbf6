"""A plot: the charts of the report on a page of their own, shown in a notebook within a frame, or saved."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from pathlib import Path

from thermodata.chart import Chart, HeatMap, script, script_json, style
from thermodata.notebook.shown import Shown
from thermodata.report.charts.figures import height_of
from thermodata.report.page.write import policy, write_page
from thermodata.report.words.numbers import typeset

_CSS = """
body{margin:0;padding:.2rem .4rem;font:14px/1.4 system-ui,sans-serif;background:var(--page,#fff);color:var(--ink,#222)}
h3{font-size:1rem;margin:.6rem 0 .3rem}
"""
_HEAD = 40  # [px] of a title


class Plot(Shown):
    """Charts below each other, each with a title. It needs no network, and nothing in it can reach the notebook."""

    def __init__(self, title: str, charts: Mapping[str, Chart | HeatMap]) -> None:
        self.title, self.charts = title, dict(charts)

    def summary(self) -> str:
        shown = "; ".join(c.about for c in self.charts.values())
        return f"{self.title}: {shown}. In a notebook it is drawn; .save('plot.html') writes it as a page."

    def page(self) -> str:
        """One HTML page that needs nothing beside it."""
        css, js = style() + _CSS, script()
        parts = "".join(
            f'<h3>{escape(typeset(title))}</h3><div data-chart="c{i}" data-height="{height_of(chart)}" '
            f'data-wheel="focus"></div><script type="application/json" id="c{i}">'
            f"{script_json(chart.as_json(coarse=True))}</script>"
            for i, (title, chart) in enumerate(self.charts.items())
        )
        return (
            '<!doctype html><html lang="en"><head><meta charset="utf-8">'
            f'<meta http-equiv="Content-Security-Policy" content="{policy(css, js)}">'
            '<meta name="viewport" content="width=device-width"><meta name="color-scheme" content="light dark">'
            f"<title>{escape(self.title)}</title><style>{css}</style></head>"
            f"<body>{parts}<script>{js}</script></body></html>"
        )

    def save(self, path: Path | str) -> Path:
        """Write the page; a cut write leaves no half page."""
        return write_page(path, self.page())

    def html(self) -> str:
        """A frame of its own: the page's styles and scripts stay away from the notebook's."""
        height = sum(height_of(c) + _HEAD for c in self.charts.values()) + 24
        return (
            f'<iframe title="{escape(self.title)}" srcdoc="{escape(self.page())}" sandbox="allow-scripts" '
            f'width="100%" height="{height}" style="border:0"></iframe>'
        )
