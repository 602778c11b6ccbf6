"""The chart of the workbench's benchmark in a real browser: when it is drawn, what was sent, how long a zoom takes."""

from __future__ import annotations

import base64
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from chromium import Chromium, Page, browser, find

__all__ = ["OURS", "PANEL", "PANEL_WHOLE", "Chromium", "Kind", "Seen", "browser", "find", "look"]

# the time of the page at which its chart stood there for two frames
_WATCH = """(() => {
  const frame = f => requestAnimationFrame(() => requestAnimationFrame(f));
  const ready = () => { try { return (READY); } catch { return false; } };
  const told = () => { window.drawnAt = performance.now(); };
  const look = () => { if (ready()) frame(told); else requestAnimationFrame(look); };
  requestAnimationFrame(look);
})()"""
# from the zoom until its finer points stood there for two frames
_ZOOM = """(() => new Promise(done => {
  const began = performance.now(), frame = f => requestAnimationFrame(() => requestAnimationFrame(f));
  const refined = () => frame(() => done(performance.now() - began));
  const low = LOW, high = HIGH;
  ACT
}))()"""


@dataclass(frozen=True)
class Kind:
    """ready: true once the chart is there. act: zooms to low..high [h], and calls refined() once finer points came."""

    ready: str
    act: str


OURS = Kind(
    "ThermoChart.of(document.getElementById('plot'))",
    "const plot = document.getElementById('plot'); delete plot.dataset.refined; ThermoChart.of(plot).zoom(low, high);"
    "const look = () => plot.dataset.refined ? refined() : requestAnimationFrame(look); look();",
)
_MODELS = "const models = [...Bokeh.documents[0].all_models], of = type => models.find(m => m.type === type);"
_READY = "Bokeh.documents.some(d => d.is_idle && [...d.all_models].some(m => m.type === 'Figure'))"
PANEL = Kind(
    _READY,
    _MODELS + "const source = of('ColumnDataSource'), changed = source.properties.data.change;"
    "const once = () => { source.disconnect(changed, once); refined(); };"
    "source.connect(changed, once); of('Range1d').setv({start: low, end: high});",
)
PANEL_WHOLE = Kind(_READY, _MODELS + "of('Range1d').setv({start: low, end: high}); refined();")


@dataclass(frozen=True)
class Seen:
    """drawn_ms: from the start of loading. kb: all that was sent until then. zooms_ms: of each zoom."""

    drawn_ms: float
    kb: float
    zooms_ms: list[float]
    elsewhere: int

    @property
    def p50_ms(self) -> float:
        return float(np.median(self.zooms_ms))

    @property
    def p95_ms(self) -> float:
        return float(np.quantile(self.zooms_ms, 0.95))


def look(
    chromium: Chromium,
    url: str,
    kind: Kind,
    zooms: Sequence[tuple[float, float]],
    cookie: tuple[str, str] | None = None,
) -> Seen:
    """url: of the chart's page. zooms: (from, to) [h]. cookie: (name, value) that lets in. A tab of its own, with
    nothing kept from an earlier one."""
    tab = chromium.open("about:blank#blank", 1280, 900)
    try:
        tab.call("Network.setCacheDisabled", cacheDisabled=True)
        if cookie:
            tab.call("Network.setCookie", name=cookie[0], value=cookie[1], url=url, sameSite="Strict", httpOnly=True)
        tab.call("Page.addScriptToEvaluateOnNewDocument", source=_WATCH.replace("READY", kind.ready))
        tab.go(url)
        drawn_ms = float(tab.wait("window.drawnAt"))
        kb = _sent(tab) / 1000
        times = [
            float(tab.js(_ZOOM.replace("LOW", repr(a)).replace("HIGH", repr(b)).replace("ACT", kind.act)))
            for a, b in zooms
        ]
        origin = "/".join(url.split("/")[:3])
        elsewhere = sum(not u.startswith((origin, "data:", "blob:", "about:")) for u in tab.requests())
        return Seen(drawn_ms, kb, times, elsewhere)
    finally:
        tab.close()


def _sent(tab: Page) -> float:
    """Bytes that came over the network, those of a web socket with them."""
    files = sum(e["encodedDataLength"] for e in tab.events("Network.loadingFinished"))
    frames = [e["response"] for e in tab.events("Network.webSocketFrameReceived")]
    return files + sum(
        len(base64.b64decode(f["payloadData"])) if f["opcode"] == 2 else len(f["payloadData"].encode()) for f in frames
    )
