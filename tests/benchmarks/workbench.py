"""How soon the workbench answers: server up and first page, first plot, zoom, memory, script.

    nice -n 19 uv run --no-sync python tests/benchmarks/workbench.py FOLDER --tests 10 --hours 24 --channels 8

Writes its own store of that size under FOLDER (once), and asks a real server over a socket. Times are wall clock of
this machine, and beside them processor time of the server, which a busy machine leaves alone; the last line is JSON.
The issue's size is --tests 100 --hours 24 --channels 40 at 1 Hz; the plot has 12 channels, a million samples.
"""

from __future__ import annotations

import argparse
import http.client
import json
import os
import subprocess
import sys
import time
from datetime import datetime
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from thermodata.chart.assets import script
from thermodata.store import Store
from thermodata.store.base.connection import insert

_CURVES = 12
START_NS = 1_772_000_000_000_000_000


def make(folder: Path, tests: int, hours: float, channels: int) -> Path:
    """A store with one stream a test; nothing where it is there."""
    path = folder / f"store-{tests}-{hours:g}-{channels}"
    if (path / "catalog.duckdb").exists():
        return path
    store = Store(path, create=True)
    now, n = datetime(2026, 3, 1), int(hours * 3600)
    t_s = np.arange(n, dtype=float)
    names = [f"T_{i:02}" for i in range(channels)]
    rows: dict[str, list[dict[str, object]]] = {"test": [], "channel": [], "file": [], "source": []}
    for k in range(tests):
        rng, test = np.random.default_rng(k), f"t{k:03}"
        columns: dict[str, object] = {
            "t": pa.array(START_NS + (t_s * 1e9).astype("int64")).cast(pa.timestamp("ns")),
            "t_s": t_s,
        }
        for name in names:
            columns[name] = np.round(20 + np.cumsum(rng.normal(0, 0.01, n)), 3)
            columns[name + "__flag"] = np.zeros(n, "uint16")
        pq.write_table(pa.table(columns), path / f"tidy/{test}.parquet", compression="zstd", row_group_size=100_000)
        own = {"campaign": "big", "test": test}
        rows["test"].append(
            {
                **own,
                "kind": "mixed",
                "role": "calibration",
                "start_ns": START_NS,
                "clock": "absolute",
                "conditions": "{}",
                "duration_s": float(n - 1),
            }
        )
        rows["source"].append(
            {
                **own,
                "source": "daq",
                "stream": "daq",
                "reader": "table",
                "clock": "absolute",
                "rows": n,
                "offset_ns": 0,
                "step_s": 1.0,
            }
        )
        rows["file"].append(
            {
                **own,
                "source": "daq",
                "stream": "daq",
                "layer": "tidy",
                "part": "test",
                "key": test,
                "path": f"tidy/{test}.parquet",
                "rows": n,
                "columns": json.dumps({"samples": n * channels, "flags": {}}),
                "added_at": now,
            }
        )
        rows["channel"] += [
            {
                **own,
                "channel": c,
                "source": "daq",
                "stream": "daq",
                "quantity": "temperature",
                "unit": "degC",
                "sign": "+",
                "dtype": "float64",
            }
            for c in names
        ]
    with store.write() as con:
        insert(
            con,
            "campaign",
            [{"campaign": "big", "spec": "{}", "spec_hash": "h", "ingested_at": now, "data_version": "v1"}],
        )
        for table, listed in rows.items():
            insert(con, table, listed)
    return path


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    for name, default in (("tests", 10), ("hours", 24), ("channels", 8), ("zooms", 30)):
        parser.add_argument(f"--{name}", type=int, default=default)
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    path = make(given.folder, given.tests, given.hours, given.channels)
    began = time.perf_counter()
    server = subprocess.Popen(
        [sys.executable, "-m", "thermodata", "workbench", str(path), "--no-browser", "--json"],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert server.stdout is not None
    text = ""
    while not text.rstrip().endswith("}"):
        text += server.stdout.readline()
    address = urlsplit(json.loads(text)["address"])
    link = http.client.HTTPConnection(address.netloc, timeout=60)

    def processor_s() -> float:
        """Of the server since it began, its threads included."""
        fields = Path(f"/proc/{server.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def get(url: str, cookie: str = "") -> tuple[float, http.client.HTTPResponse, bytes]:
        at = time.perf_counter()
        link.request("GET", url, headers={"cookie": cookie} if cookie else {})
        answer = link.getresponse()
        body = answer.read()
        assert answer.status == 200, (answer.status, body[:500])
        return time.perf_counter() - at, answer, body

    try:
        _, opened, _ = get(f"{address.path}?{address.query}")
        cookie = (opened.getheader("set-cookie") or "").split(";")[0]
        get("/", cookie)
        first_page_s, first_page_cpu_s = time.perf_counter() - began, processor_s()
        show = ",".join(f"T_{i:02}" for i in range(min(_CURVES, given.channels)))
        base = f"campaign=big&test=t000&show={show}"
        first_plot_s, _, body = get(f"/test?{base}", cookie)
        first_plot_cpu_s = processor_s() - first_page_cpu_s
        rng, zooms = np.random.default_rng(0), []
        for _ in range(given.zooms):
            width = given.hours * 3600 * float(rng.uniform(0.01, 0.6))
            low = float(rng.uniform(0, given.hours * 3600 - width))
            zooms.append(get(f"/test/data?{base}&from={low:.1f}&to={low + width:.1f}", cookie)[0])
        zoom_cpu_s = (processor_s() - first_page_cpu_s - first_plot_cpu_s) / given.zooms
        status = Path(f"/proc/{server.pid}/status").read_text()
        peak_mib = int(next(line for line in status.splitlines() if line.startswith("VmHWM")).split()[1]) / 1024
    finally:
        server.terminate()
        server.wait()
    web = Path(__file__).parents[2] / "thermodata" / "web" / "static"
    found = {
        "tests": given.tests,
        "hours": given.hours,
        "channels": given.channels,
        "samples_of_the_plot": given.hours * 3600 * min(_CURVES, given.channels),
        "first_page_s": round(first_page_s, 3),
        "first_page_processor_s": round(first_page_cpu_s, 2),
        "first_plot_s": round(first_plot_s, 3),
        "first_plot_processor_s": round(first_plot_cpu_s, 2),
        "page_kb": round(len(body) / 1000),
        "zoom_p50_ms": round(1000 * float(np.median(zooms)), 1),
        "zoom_p95_ms": round(1000 * float(np.quantile(zooms, 0.95)), 1),
        "zoom_processor_ms": round(1000 * zoom_cpu_s, 1),
        "peak_mib": round(peak_mib),
        "script_kb": round(
            (len(script()) + sum((web / f).stat().st_size for f in ("htmx/htmx.min.js", "workbench.js"))) / 1000
        ),
    }
    print(json.dumps(found))


if __name__ == "__main__":
    main()
