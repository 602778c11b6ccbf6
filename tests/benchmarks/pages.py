"""The saved pages: what they weigh, and how soon a browser shows them.

    uv run python tests/benchmarks/pages.py [--demo FOLDER] [--runs 5]

FOLDER is that of an earlier `thermodata demo` (else one is made). A limit stands beside each figure. Needs a Chromium
in PATH or in THERMODATA_CHROMIUM. Times are of the page, from the start of its loading.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

from measure import PROGRAM, machine, run, table

sys.path.insert(0, str(Path(__file__).parents[1]))
from chromium import Chromium, browser, find

from thermodata.chart import script

KB = 1000
LIMITS = {"page [kB]": 1000, "first plot [ms]": 1000, "zoom [ms]": 150}
ZOOM = """(() => {
  const chart = ThermoChart.of(document.querySelector('[data-chart=test0]')), [a, b] = chart.full;
  const begin = performance.now();
  for (let i = 1; i <= 20; i++) chart.zoom(a + (b - a) * i / 100, b - (b - a) * i / 100);
  return new Promise(done => requestAnimationFrame(() => done((performance.now() - begin) / 20)));
})()"""


def pages(demo: Path, folder: Path) -> dict[str, Path]:
    """The report of the newest version, of the first one, and the quality page."""
    store = demo / "thermodata.store"
    versions = run([PROGRAM, "--store", store, "history", "baseline", "--json"]).answer
    made = {f"report, version {i} of {len(versions)}": v["model"] for i, v in enumerate(versions, 1)}
    out = {}
    for number, (name, model) in enumerate(made.items()):
        out[name] = folder / f"report{number}.html"
        run([PROGRAM, "--store", store, "report", model, "-o", out[name], "--json"])
    out["quality"] = folder / "quality.html"
    run([PROGRAM, "--store", store, "quality", "-o", out["quality"], "--json"])
    return out


def times(chromium: Chromium, page: Path, runs: int) -> list[tuple[float, float, float]]:
    """(first plot, all plots drawn at once, one zoom) [ms] of each run, in a tab of its own."""
    found = []
    for _ in range(runs):
        tab = chromium.open(page.as_uri(), 1280, 900)
        tab.js("document.querySelector('[data-chart]').scrollIntoView()")
        first = tab.wait("ThermoChart.first", 60.0)
        begin = time.perf_counter()
        tab.js("document.querySelectorAll('[data-chart]').forEach(b => ThermoChart.of(b))")
        every = (time.perf_counter() - begin) * 1e3
        found.append((first, every, tab.js(ZOOM)))
        tab.close()
    return found


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--demo", type=Path)
    arguments.add_argument("--runs", type=int, default=5)
    given = arguments.parse_args()
    program = find()
    if program is None:
        raise SystemExit("no Chromium: install one, or name it in THERMODATA_CHROMIUM")
    rows = []
    with tempfile.TemporaryDirectory() as name, browser(program) as chromium:
        folder = Path(name)
        if given.demo is None:
            run([PROGRAM, "demo", folder / "demo", "--hide", "coolant", "--seed", "7", "--json"])
        for what, page in pages(given.demo or folder / "demo", folder).items():
            first, every, zoom = (median(v) for v in zip(*times(chromium, page, given.runs), strict=True))
            size = page.stat().st_size / KB
            rows.append((what, f"{size:.0f}", f"{first:.0f}", f"{every:.0f}", f"{zoom:.1f}"))
    print(machine())
    print(f"script {len(script().encode()) / KB:.0f} kB; limits: {', '.join(f'{k} {v}' for k, v in LIMITS.items())}\n")
    print(table(("page", "page [kB]", "first plot [ms]", "all plots [ms]", "zoom [ms]"), rows))


if __name__ == "__main__":
    main()
