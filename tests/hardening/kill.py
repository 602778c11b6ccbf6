"""kill -9 at random moments of a real ingest (TDMS, control CSV and MCAP), and of forget, gc, migrate and snapshot.

    .venv/bin/python tests/hardening/kill.py [--moments 30] [--seed 0] [--folder DIR]

After each kill: every view answers, manifest and files agree; the ingest run again ends equal to an undisturbed one.
Prints a table; exit code 1 where anything was between before and after.
"""

from __future__ import annotations

import argparse
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

import whole  # noqa: E402

from thermodata.store import Store  # noqa: E402
from thermodata.store.ingest.run import ingest  # noqa: E402
from thermodata.store.keep.gc import gc  # noqa: E402


def started(op: str, store: Path, argument: object) -> subprocess.Popen[str]:
    process = subprocess.Popen(
        [sys.executable, str(HERE / "victim.py"), op, str(store), str(argument)], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    process.stdout.readline()
    return process


def undisturbed_s(op: str, store: Path, argument: object) -> float:
    begun = time.monotonic()
    process = started(op, store, argument)
    begun = time.monotonic()
    if process.wait() != 0:
        raise SystemExit(f"{op} fails undisturbed")
    return time.monotonic() - begun


def killed(op: str, store: Path, argument: object, after_s: float) -> bool:
    """Whether it was still working when the signal came."""
    process = started(op, store, argument)
    try:
        process.wait(after_s)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        return True
    return False


def lab_in(folder: Path) -> Path:
    """A simulated campaign of three tests with TDMS, CNC and MCAP logs."""
    from thermodata.cli.app import run

    if run(["simulate", str(folder), "--seed", "1"]) != 0:
        raise SystemExit("simulate fails")
    campaign = folder / "campaign.yaml"
    head, tests = campaign.read_text(encoding="utf-8").split("tests:\n", 1)
    campaign.write_text(head + "tests:\n" + "".join(tests.splitlines(keepends=True)[:3]), encoding="utf-8")
    return campaign


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--moments", type=int, default=30)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--only", help="one of the operations")
    given = parser.parse_args()
    place = given.folder or Path(tempfile.mkdtemp(prefix="kill-"))
    rng = random.Random(given.seed)
    campaign = lab_in(place / "lab")
    name = next(line.split(":")[1].strip() for line in campaign.read_text().splitlines() if line.startswith("id:"))
    Store(place / "empty/store", create=True)
    shutil.copytree(place / "empty", place / "full")
    whole_s = undisturbed_s("ingest", place / "full/store", campaign)
    expected = whole.content(place / "full/store")
    full = whole.check(place / "full/store")["sample"]
    print(f"undisturbed ingest: {whole_s:.2f} s, {full} samples, digest {expected}")
    with Store(place / "full/store").reader() as con:
        first = con.execute("select test from test limit 1").fetchone()
    assert first is not None
    plan = [
        ("ingest", "empty", str(campaign), given.moments),
        ("forget", "full", f"{name}/{first[0]}", 6),
        ("gc", "full", "-", 6),
        ("migrate", "full", "-", 6),
        ("snapshot", "full", str(place / "out.duckdb"), 6),
    ]
    bad = 0
    print(
        f"\n{'operation':10} {'killed':>7} {'too late':>9} {'before':>7} {'after':>6} {'between':>8} "
        f"{'again equal':>12} {'left over':>10}"
    )
    for op, start, argument, moments in (p for p in plan if given.only in (None, p[0])):
        shutil.copytree(place / start, place / "try")
        if op == "gc":
            _litter(place / "try/store")
        lasts = undisturbed_s(op, place / "try/store", argument)
        after = whole.content(place / "try/store") if op != "migrate" else ""
        before = whole.content(place / start / "store")
        (place / "out.duckdb").unlink(missing_ok=True)
        shutil.rmtree(place / "try")
        seen: Counter[str] = Counter()
        for i in range(moments):
            cut = False
            while not cut:  # one that had finished before the signal shows nothing
                shutil.rmtree(place / "try", ignore_errors=True)
                (place / "out.duckdb").unlink(missing_ok=True)
                shutil.copytree(place / start, place / "try")
                store = place / "try/store"
                if op == "gc":
                    _litter(store)
                cut = killed(op, store, argument, rng.uniform(0, lasts))
                seen["killed" if cut else "finished"] += 1
            (place / "out.duckdb").unlink(missing_ok=True)
            try:
                if op == "migrate":
                    state = _migrated(store)
                else:
                    whole.check(store)
                    now = whole.content(store)
                    state = "after" if now == after and now != before else "before" if now == before else "between"
                seen[state] += 1
                if op == "ingest":
                    summary = ingest(Store(store), campaign)
                    seen["equal"] += whole.content(store) == expected and not summary.losses
                elif op != "migrate":
                    seen["equal"] += (
                        undisturbed_s(op, store, argument) >= 0 and whole.content(store) == after
                        if op != "forget" or state == "before"
                        else 1
                    )
                else:
                    seen["equal"] += undisturbed_s(op, store, argument) >= 0 and _migrated(store) == "after"
                if op != "migrate":
                    gc(Store(store), grace_s=0)
                    whole.check(store)
                    seen["left"] += len(whole.left_over(store))
            except Exception as error:
                seen["between"] += 1
                print(f"  {op} moment {i}: {type(error).__name__}: {error}")
            (place / "out.duckdb").unlink(missing_ok=True)
            shutil.rmtree(place / "try")
        bad += seen["between"] + (moments - seen["equal"]) + seen["left"]
        print(
            f"{op:10} {seen['killed']:7} {seen['finished']:9} {seen['before']:7} {seen['after']:6} "
            f"{seen['between']:8} {seen['equal']:9}/{moments:<2} {seen['left']:10}",
            flush=True,
        )
    if given.folder is None:
        shutil.rmtree(place)
    print("\nall whole" if not bad else f"\n{bad} wrong")
    return 1 if bad else 0


def _litter(store: Path) -> None:
    for i in range(200):
        (store / f"tidy/unknown{i}.parquet").write_bytes(b"left over")
        (store / f"raw/.{i}.tmp").write_bytes(b"left over")


def _migrated(store: Path) -> str:
    import duckdb

    con = duckdb.connect(str(store / "catalog.duckdb"), read_only=True)
    try:
        version = con.execute("select format from store").fetchall()[0][0]
        new = con.execute(
            "select count(*) from duckdb_columns() where table_name = 'test' and column_name = 'shift'"
        ).fetchall()[0][0]
    finally:
        con.close()
    return {(1, 0): "before", (2, 1): "after"}.get((version, new), "between")


if __name__ == "__main__":
    sys.exit(main())
