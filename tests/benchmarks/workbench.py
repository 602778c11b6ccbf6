"""How soon the workbench answers, beside the same chart in Panel: server up, first plot, zoom, weight, memory.

    nice -n 19 uv run --no-sync python tests/benchmarks/workbench.py FOLDER --tests 10 --hours 24 --channels 8 [--panel]

Writes its own store of that size under FOLDER (once), and asks a real server over a socket; where there is a Chromium
(in PATH or THERMODATA_CHROMIUM), the chart is drawn in it as well. --panel puts Panel into an environment of its own
under FOLDER (once) and measures the same chart there, in the same run. Times are wall clock of this machine, and beside
them processor time of the server, which a busy machine leaves alone; the last line is JSON. The issue's size is
--tests 100 --hours 24 --channels 40 at 1 Hz; the plot has 12 channels, a million samples.
"""

from __future__ import annotations

import argparse
import contextlib
import http.client
import json
import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
from measure import machine, run, table
from workbench_browser import OURS, PANEL, PANEL_WHOLE, Chromium, Kind, browser, find, look
from workbench_store import make

from thermodata.chart.assets import script
from thermodata.schema.flag import INVALID

_CURVES, _HERE = 12, Path(__file__).parent
_WEB = _HERE.parents[1] / "thermodata" / "web"
# what a distribution and all that it needs take on disk, without what thermodata has anyway
_INSTALLED = """
import importlib.metadata as m, re, sys
left, seen, total = sys.argv[1].split(','), set(sys.argv[2].split(',')), 0
while left:
    name = re.sub('[-_.]+', '-', left.pop()).lower()
    if name in seen: continue
    seen.add(name)
    try: found = m.distribution(name)
    except m.PackageNotFoundError: continue
    total += sum(f.locate().stat().st_size for f in found.files or [] if f.locate().is_file())
    left += [re.match('[A-Za-z0-9._-]+', r).group() for r in found.requires or [] if 'extra ==' not in r]
print(total)
"""
_HAD = "numpy,duckdb,pyarrow,pydantic,click"


@dataclass
class Figures:
    """Times [s], of the server's processor and of the clock; sizes [MB, kB, MiB]; None where it was not measured."""

    name: str
    up_s: float
    up_processor_s: float
    chart_s: float | None = None
    chart_processor_s: float | None = None
    zooms_s: Sequence[float] = ()
    zoom_processor_s: float | None = None
    drawn_s: float | None = None
    sent_kb: float | None = None
    drawn_zooms_ms: Sequence[float] = ()
    peak_mib: float = 0
    installed_mb: float = 0

    def as_row(self) -> list[str]:
        """Wall time, and processor time of the server behind it."""
        zooms = list(self.zooms_s)
        return [
            f"{self.up_s:.2f} s ({self.up_processor_s:.2f} s)",
            "–" if self.chart_s is None else f"{self.chart_s:.2f} s ({self.chart_processor_s:.2f} s)",
            "–" if self.drawn_s is None else f"{self.drawn_s:.2f} s",
            "–" if self.sent_kb is None else f"{self.sent_kb:,.0f} kB".replace(",", " "),
            f"{_ms(zooms, 0.5)}, {_ms(zooms, 0.95)} ({1000 * (self.zoom_processor_s or 0):.0f} ms)" if zooms else "–",
            f"{_ms(self.drawn_zooms_ms, 0.5, 1)}, {_ms(self.drawn_zooms_ms, 0.95, 1)}" if self.drawn_zooms_ms else "–",
            f"{self.peak_mib:.0f} MiB",
            f"{self.installed_mb:.0f} MB",
        ]


ROWS = (
    "server up and first page, clock (processor)",
    "the chart's page or data, clock (processor)",
    "drawn in the browser, from the start of loading",
    "sent to the browser for it",
    "a zoom over HTTP: p50, p95 (processor, mean)",
    "a zoom until drawn in the browser: p50, p95",
    "memory of the server, peak",
    "installed beside what thermodata needs anyway",
)


def _ms(times: Sequence[float], share: float, unit: float = 1000) -> str:
    return f"{unit * float(np.quantile(times, share)):.0f} ms"


def processor_s(pid: int) -> float:
    """Of a process since it began, its threads included."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def peak_mib(pid: int) -> float:
    status = Path(f"/proc/{pid}/status").read_text()
    return int(next(line for line in status.splitlines() if line.startswith("VmHWM")).split()[1]) / 1024


@contextlib.contextmanager
def ended(process: subprocess.Popen[str]) -> Iterator[subprocess.Popen[str]]:
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


def ours(store: Path, channels: Sequence[str], hours: float, spans: Sequence[tuple[float, float]]) -> Figures:
    """The workbench. spans: of the zooms [h]."""
    began = time.perf_counter()
    words = [sys.executable, "-m", "thermodata", "workbench", str(store), "--no-browser", "--json"]
    with ended(subprocess.Popen(words, stdout=subprocess.PIPE, text=True)) as server:
        assert server.stdout is not None
        text = ""
        while not text.rstrip().endswith("}"):
            text += server.stdout.readline()
        address = urlsplit(json.loads(text)["address"])
        link = http.client.HTTPConnection(address.netloc, timeout=600)

        def get(url: str, cookie: str = "") -> tuple[float, http.client.HTTPResponse]:
            at = time.perf_counter()
            link.request("GET", url, headers={"cookie": cookie} if cookie else {})
            answer = link.getresponse()
            body = answer.read()
            assert answer.status == 200, (answer.status, body[:500])
            return time.perf_counter() - at, answer

        _, opened = get(f"{address.path}?{address.query}")
        cookie = (opened.getheader("set-cookie") or "").split(";")[0]
        get("/", cookie)
        found = Figures("workbench", time.perf_counter() - began, processor_s(server.pid))
        base = f"campaign=big&test=t000&show={','.join(channels)}"
        found.chart_s, _ = get(f"/test?{base}", cookie)
        found.chart_processor_s = processor_s(server.pid) - found.up_processor_s
        at = processor_s(server.pid)
        found.zooms_s = [get(f"/test/data?{base}&from={3600 * a:.1f}&to={3600 * b:.1f}", cookie)[0] for a, b in spans]
        found.zoom_processor_s = (processor_s(server.pid) - at) / len(spans)
        with chromium() as one:
            name, _, value = cookie.partition("=")
            in_browser(found, one, f"http://{address.netloc}/test?{base}", OURS, spans, (name, value))
        found.peak_mib = peak_mib(server.pid)
    web = run([sys.executable, "-c", _INSTALLED, "starlette,uvicorn,jinja2", _HAD]).answer
    own = sum(f.stat().st_size for room in (_WEB, _WEB.parent / "chart") for f in room.rglob("*") if f.is_file())
    found.installed_mb = (web + own) / 1e6
    return found


def panel(
    python: Path, store: Path, channels: Sequence[str], spans: Sequence[tuple[float, float]], binned: bool
) -> Figures:
    """The same chart there. binned: by the same query at each zoom; else all samples are sent once."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    given = {
        "file": str(store / "tidy" / "t000.parquet"),
        "port": port,
        "channels": list(channels),
        "invalid": int(INVALID),
        "binned": binned,
    }
    began = time.perf_counter()
    words = [str(python), str(_HERE / "workbench_panel.py"), json.dumps(given)]
    with ended(subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, text=True)) as server:
        while True:
            link = http.client.HTTPConnection(f"127.0.0.1:{port}", timeout=600)
            with contextlib.suppress(ConnectionRefusedError):
                link.request("GET", "/chart")
                answer = link.getresponse()
                assert answer.status == 200, answer.read()[:500]
                answer.read()
                break
            assert server.poll() is None, "Panel ended"
            time.sleep(0.01)
        name = "Panel, binned there" if binned else "Panel, all samples sent"
        found = Figures(name, time.perf_counter() - began, processor_s(server.pid))
        with chromium() as one:
            in_browser(found, one, f"http://127.0.0.1:{port}/chart", PANEL if binned else PANEL_WHOLE, spans)
        found.peak_mib = peak_mib(server.pid)
    found.installed_mb = run([python, "-c", _INSTALLED, "panel,bokeh", _HAD]).answer / 1e6
    return found


@contextlib.contextmanager
def chromium() -> Iterator[Chromium | None]:
    program = find()
    if program is None:
        yield None
        return
    with browser(program) as one:
        yield one


def in_browser(
    found: Figures,
    one: Chromium | None,
    url: str,
    kind: Kind,
    spans: Sequence[tuple[float, float]],
    cookie: tuple[str, str] | None = None,
) -> None:
    if one is None:
        return
    seen = look(one, url, kind, spans, cookie)
    found.drawn_s, found.sent_kb, found.drawn_zooms_ms = seen.drawn_ms / 1000, seen.kb, seen.zooms_ms


def with_panel(folder: Path) -> Path:
    """The interpreter of an environment that has Panel, made once."""
    python = folder / "panel" / "bin" / "python"
    if not python.exists():
        subprocess.run(["uv", "venv", "--quiet", str(folder / "panel")], check=True)
        wanted = ["panel", "bokeh", "duckdb"]
        subprocess.run(["uv", "pip", "install", "--quiet", "--python", str(python), *wanted], check=True)
    return python


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    for name, default in (("tests", 10), ("hours", 24), ("channels", 8), ("zooms", 30)):
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--panel", action="store_true")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    store = make(given.folder, given.tests, given.hours, given.channels)
    channels = [f"T_{i:02}" for i in range(min(_CURVES, given.channels))]
    rng, spans = np.random.default_rng(0), []
    for _ in range(given.zooms):
        width = given.hours * float(rng.uniform(0.01, 0.6))
        low = float(rng.uniform(0, given.hours - width))
        spans.append((low, low + width))
    print(machine())
    found = [ours(store, channels, given.hours, spans)]
    if given.panel:
        python = with_panel(given.folder)
        found += [panel(python, store, channels, spans, binned) for binned in (True, False)]
    print(machine())
    rows = zip(ROWS, *(f.as_row() for f in found), strict=True)
    print(table(["", *(f.name for f in found)], list(rows)))
    scripts = len(script()) + sum((_WEB / "static" / f).stat().st_size for f in ("htmx/htmx.min.js", "workbench.js"))
    samples = given.hours * 3600 * len(channels)
    print(
        json.dumps(
            {"samples_of_the_plot": samples, "script_kb": round(scripts / 1000), "of": [f.__dict__ for f in found]}
        )
    )


if __name__ == "__main__":
    main()
