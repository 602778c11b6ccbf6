"""Pictures of every page of the workbench, light and dark, wide and narrow, for a person to look at.

    uv run --no-sync python -m tests.web.pictures STORE OUT

Needs a Chromium in PATH or in THERMODATA_CHROMIUM. The pages are those of the newest model and of the first test.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import quote

from thermodata.store import Store
from thermodata.view.lists.models import model_rows

from ..chromium import browser, find

SIZES = {"wide": 1280, "narrow": 390}


def pages_of(store: Store) -> dict[str, str]:
    """Name of the picture -> path."""
    with store.reader() as con:
        campaign, test = con.execute("select campaign, test from test where role <> 'locked' limit 1").fetchall()[0]
        channel = con.execute("select channel from channel where test = ? limit 1", [test]).fetchall()[0][0]
    at = f"campaign={quote(campaign)}&test={quote(test)}"
    pages = {"tests": "/", "quality": "/quality"}
    pages |= {"test": f"/test?{at}", "trace": f"/trace?{at}&channel={quote(channel)}&at=3600"}
    if models := model_rows(store):
        pages |= {"missing": "/missing", "compare": "/compare", "report": "/report"}
        if models[0].parent:
            pages["missing-before"] = f"/missing?model={models[0].parent}"
            pages["add"] = f"/add?model={models[0].parent}&candidate=1"
            pages["confirm"] = f"/confirm?model={models[0].parent}&candidate=2"
    query = quote(f"select t_s, value from signal('{campaign}', '{test}', '{channel}')")
    return {**pages, "sql": f"/sql?q={query}", "start": "/start"}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("store", type=Path)
    parser.add_argument("out", type=Path)
    given = parser.parse_args()
    program = find()
    if program is None:
        raise SystemExit("no Chromium: install one, or name it in THERMODATA_CHROMIUM")
    given.out.mkdir(parents=True, exist_ok=True)
    server = subprocess.Popen(
        [sys.executable, "-m", "thermodata", "workbench", str(given.store), "--write", "--no-browser", "--json"],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert server.stdout is not None
    text = ""
    while not text.rstrip().endswith("}"):
        text += server.stdout.readline()
    address = json.loads(text)["address"]
    origin = "/".join(address.split("/")[:3])
    try:
        with browser(program) as one:
            tab = one.open(address)
            tab.wait("location.pathname === '/' && document.readyState === 'complete'")
            for name, path in pages_of(Store(given.store)).items():
                for size, width in SIZES.items():
                    for dark in (False, True):
                        tab.look(width, 900, dark)
                        tab.go(origin + path)
                        time.sleep(0.5)
                        out = given.out / f"{name}-{size}-{'dark' if dark else 'light'}.png"
                        tab.picture(out)
                        print(out)
            for complaint in tab.complaints():
                print(f"the page complains: {complaint}", file=sys.stderr)
    finally:
        server.kill()
        server.wait()


if __name__ == "__main__":
    main()
