"""Two ingests and eight readers at once, each a process: all succeed, and no writer waits over a second for the lock.

    .venv/bin/python tests/hardening/together.py [--ingests 6] [--readers 8] [--tests 8]

Each writer ingests its campaign again and again, edited every time; readers ask without a pause. Prints the waits.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "store")]


def write(store_path: Path, campaign: Path, rounds: int) -> dict[str, object]:
    """Ingests, each time with another calibration; returns how long each turn at the catalogue was waited for."""
    import store_fakes

    from thermodata.store import Store
    from thermodata.store.catalogue import store as store_module
    from thermodata.store.ingest.run import ingest

    store_fakes.install()
    waits: list[float] = []
    turns: list[float] = []
    right = store_module.catalogue_lock

    class Timed:
        def __init__(self, *args: object, **more: object) -> None:
            self.kept, self.exclusive = right(*args, **more), more.get("exclusive")  # type: ignore[arg-type]

        def __enter__(self) -> None:
            begun = time.monotonic()
            self.kept.__enter__()
            self.entered = time.monotonic()
            if self.exclusive:
                waits.append(self.entered - begun)

        def __exit__(self, *error: object) -> None:
            if self.exclusive:
                turns.append(time.monotonic() - self.entered)
            self.kept.__exit__(*error)  # type: ignore[arg-type]

    store_module.catalogue_lock = Timed  # type: ignore[assignment]
    text = campaign.read_text()
    for i in range(rounds):
        campaign.write_text(text.replace("10 um/V", f"{10 + i} um/V"))
        summary = ingest(Store(store_path), campaign)
        assert summary.changed
        assert summary.losses == []
    return {"waits": waits, "turns": turns}


def read(store_path: Path, stop: Path, pause_s: float) -> dict[str, object]:
    """Asks until the file `stop` is there, or whoever would write it is not; each answer must be of one commit."""
    from thermodata.store import Store

    waits: list[float] = []
    parent = os.getppid()
    while not stop.exists() and os.getppid() == parent:
        time.sleep(pause_s)
        begun = time.monotonic()
        store = Store(store_path)
        with store.reader() as con:
            waits.append(time.monotonic() - begun)
            tests = con.execute("select count(*) from test").fetchone()
            seen = con.execute("select count(distinct (campaign, test)) from sample").fetchone()
            assert tests == seen, (tests, seen)
    return {"waits": waits}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ingests", type=int, default=6)
    parser.add_argument("--writers", type=int, default=2)
    parser.add_argument("--readers", type=int, default=8)
    parser.add_argument("--tests", type=int, default=8)
    parser.add_argument("--pause", type=float, default=0.0, help="between two questions of a reader [s]")
    parser.add_argument("--worker", nargs=3)
    given = parser.parse_args()
    if given.worker:
        what, store, argument = given.worker
        found = (
            read(Path(store), Path(argument), given.pause)
            if what == "read"
            else write(Path(store), Path(argument), given.ingests)
        )
        print(json.dumps(found))
        return 0
    import store_fakes

    from thermodata.store import Store

    place = Path(tempfile.mkdtemp(prefix="together-"))
    Store(place / "store", create=True)
    campaigns = []
    for i in range(given.writers):
        head = store_fakes.CAMPAIGN.replace("id: shop", f"id: shop{i}").split("tests:\n")[0]
        tests = "".join(f"  - {{id: t{k}, kind: other}}\n" for k in range(given.tests))
        campaigns.append(store_fakes.write_campaign(place / f"lab{i}", head + "tests:\n" + tests, logs=False))
        for k in range(given.tests):
            store_fakes.write_log(place / f"lab{i}/raw/t{k}_a.npz", store_fakes.daq(2000, seed=100 * i + k))
            store_fakes.write_log(
                place / f"lab{i}/raw/t{k}.nc.npz",
                {"nc": {"t_ns": store_fakes.times(200, 10.0), "n": [9000.0 + k] * 200, "msg": ["RUN"] * 200}},
            )
    stop = place / "stop"

    def start(what: str, argument: Path) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [
                sys.executable,
                __file__,
                "--ingests",
                str(given.ingests),
                "--pause",
                str(given.pause),
                "--worker",
                what,
                str(place / "store"),
                str(argument),
            ],
            stdout=subprocess.PIPE,
            text=True,
        )

    readers = [start("read", stop) for _ in range(given.readers)]
    writers = [start("write", campaign) for campaign in campaigns]
    results = {"writer": [w.communicate()[0] for w in writers]}
    stop.touch()
    results["reader"] = [r.communicate()[0] for r in readers]
    failed = [p.returncode for p in (*writers, *readers) if p.returncode]
    print(f"{'process':12} {'turns':>6} {'median wait [ms]':>17} {'longest wait [ms]':>18} {'longest turn [ms]':>18}")
    worst = 0.0
    for kind, outs in results.items():
        for i, out in enumerate(outs):
            if not out:
                continue
            found = json.loads(out)
            waits, turns = sorted(found["waits"]), found.get("turns") or [0.0]
            worst = max(worst, waits[-1]) if kind == "writer" else worst
            print(
                f"{kind} {i:<5} {len(waits):6} {1e3 * waits[len(waits) // 2]:17.1f} {1e3 * waits[-1]:18.1f} "
                f"{1e3 * max(turns):18.1f}"
            )
    shutil.rmtree(place)
    print(f"\nfailed: {len(failed)} of {len(writers) + len(readers)}; longest wait of a writer {worst:.3f} s")
    return 1 if failed or worst > 1 else 0


if __name__ == "__main__":
    sys.exit(main())
