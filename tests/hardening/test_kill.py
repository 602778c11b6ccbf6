"""kill -9 leaves a store as before or as after; `kill.py` beside this does it at 30 random moments of a real ingest."""

from __future__ import annotations

import json
import random
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import duckdb
import pytest

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "store")]

import store_fakes  # noqa: E402
import whole  # noqa: E402

from thermodata.store import Store  # noqa: E402
from thermodata.store.catalogue.format.ddl import FORMAT  # noqa: E402
from thermodata.store.ingest.reading import campaign_files  # noqa: E402
from thermodata.store.ingest.run import ingest  # noqa: E402
from thermodata.store.keep.gc import gc  # noqa: E402

Victim = Callable[..., tuple[int, int]]
NEXT = FORMAT + 1  # which `victim.py` knows a step to


@pytest.fixture(scope="module")
def victim() -> Iterator[Victim]:
    """victim(op, store, argument, die_at) -> (exit code, steps) of a process of its own."""
    words = [sys.executable, str(HERE / "victim.py"), "serve"]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdin is not None
        assert server.stdout is not None

        def run(op: str, store: Path, argument: object, die_at: int = 0) -> tuple[int, int]:
            asked = [op, str(store), str(argument), "--die-at", str(die_at), "--fakes", str(HERE.parent / "store")]
            print(json.dumps(asked), file=server.stdin, flush=True)
            code, said = json.loads(server.stdout.readline())
            assert code in (0, -signal.SIGKILL), said
            return code, int(said.split()[-1]) if code == 0 else 0

        yield run


@pytest.fixture(scope="module")
def lab(once: Callable[[str, Callable[[Path], object]], Path]) -> Path:
    """A folder with a campaign, an empty store `before`, one that holds it `after`, and one with a changed file."""

    def make(folder: Path) -> None:
        campaign = store_fakes.write_campaign(folder / "lab")
        Store(folder / "before/store", create=True)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(campaign_files, "find_reader", lambda name: store_fakes.NpzReader())
            ingest(Store(folder / "after/store", create=True), campaign)

    return once("lab", make)


@pytest.fixture(autouse=True)
def fakes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(campaign_files, "find_reader", lambda name: store_fakes.NpzReader())


def fresh(source: Path, tmp_path: Path, n: object) -> Path:
    place = tmp_path / str(n)
    shutil.copytree(source.parent, place)
    return place / source.name


def moments(steps: int, count: int, seed: int) -> list[int]:
    """The last ones, about the commit, and some before."""
    last = list(range(max(1, steps - 1), steps + 1))
    return sorted({*last, *random.Random(seed).sample(range(1, steps + 1), min(count, steps))})


def test_a_killed_ingest_leaves_the_store_before_or_after_and_goes_on(
    victim: Victim, lab: Path, tmp_path: Path
) -> None:
    campaign = lab / "lab/campaign.yaml"
    _, steps = victim("ingest", fresh(lab / "before/store", tmp_path, 0), campaign)
    assert steps > 15
    whole_digest, seen = whole.content(tmp_path / "0/store"), set()
    for die_at in moments(steps, 2, seed=1):
        store = fresh(lab / "before/store", tmp_path, die_at)
        assert victim("ingest", store, campaign, die_at)[0] == -signal.SIGKILL
        seen.add(whole.check(store)["sample"])
        ingest(Store(store), campaign)
        assert whole.content(store) == whole_digest
        gc(Store(store), grace_s=0)
        whole.check(store)
        assert whole.left_over(store) == []
        assert len(list(store.rglob("*.parquet"))) == len(list((tmp_path / "0/store").rglob("*.parquet")))
    assert seen == {0, 7460}


def test_a_killed_forget_leaves_the_store_before_or_after(victim: Victim, lab: Path, tmp_path: Path) -> None:
    _, steps = victim("forget", fresh(lab / "after/store", tmp_path, 0), "shop/one")
    found = []
    for die_at in moments(steps, 1, seed=2):
        store = fresh(lab / "after/store", tmp_path, die_at)
        assert victim("forget", store, "shop/one", die_at)[0] == -signal.SIGKILL
        found.append(whole.check(store)["sample"])
    assert found[-2:] == [7460, 3730]  # either side of the commit


def test_a_killed_gc_leaves_a_whole_store_and_goes_on(victim: Victim, lab: Path, tmp_path: Path) -> None:
    def start(n: object) -> Path:
        store = fresh(lab / "after/store", tmp_path, n)
        for i in range(4):
            (store / f"tidy/.{i}.tmp").write_bytes(b"left over")
            (store / f"raw/unknown{i}.parquet").write_bytes(b"left over")
        return store

    _, steps = victim("gc", start(0), "-")
    for die_at in moments(steps, 0, seed=3):
        store = start(die_at)
        assert victim("gc", store, "-", die_at)[0] == -signal.SIGKILL
        assert whole.check(store)["sample"] == 7460
        gc(Store(store), grace_s=0)
        assert not [p for p in store.rglob("*") if "unknown" in p.name or p.name.endswith(".tmp")]
        assert whole.check(store)["sample"] == 7460


def test_a_killed_migration_leaves_the_old_store_or_the_new_one_and_a_whole_backup(
    victim: Victim, lab: Path, tmp_path: Path
) -> None:
    def asked(path: Path, query: str) -> object:
        con = duckdb.connect(str(path), read_only=True)
        try:
            return con.execute(query).fetchall()[0][0]
        finally:
            con.close()

    _, steps = victim("migrate", fresh(lab / "after/store", tmp_path, 0), "-")
    formats = []
    for die_at in moments(steps, 2, seed=4):
        store = fresh(lab / "after/store", tmp_path, die_at)
        assert victim("migrate", store, "-", die_at)[0] == -signal.SIGKILL
        formats.append(asked(store / "catalog.duckdb", "select format from store"))
        backups = list(store.glob("catalog.format*.backup"))
        if formats[-1] == NEXT:
            assert asked(store / "catalog.duckdb", "select count(*) from test where shift = 'early'") == 2
        assert len(backups) == 1 or formats[-1] == FORMAT
        for backup in backups:
            assert asked(backup, "select format from store") == FORMAT
            assert asked(backup, "select count(*) from test") == 2
    assert formats[-1] == NEXT
    assert victim("migrate", store, "-")[0] == 0


def test_a_killed_snapshot_is_no_snapshot(victim: Victim, lab: Path, tmp_path: Path) -> None:
    store = fresh(lab / "after/store", tmp_path, "s")
    out = tmp_path / "s/all.duckdb"
    _, steps = victim("snapshot", store, out)
    out.unlink()
    for die_at in moments(steps, 1, seed=5):
        assert victim("snapshot", store, out, die_at)[0] == -signal.SIGKILL
        whole.check(store)
        if out.exists():  # killed after it got its name: then it is one
            out.unlink()
    assert victim("snapshot", store, out)[0] == 0


def test_kill_at_a_random_moment(lab: Path, tmp_path: Path) -> None:
    seed = 0
    store = fresh(lab / "before/store", tmp_path, seed)
    process = subprocess.Popen(
        [
            sys.executable,
            str(HERE / "victim.py"),
            "ingest",
            str(store),
            str(lab / "lab/campaign.yaml"),
            "--fakes",
            str(HERE.parent / "store"),
        ],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    process.stdout.readline()
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(random.Random(seed).uniform(0.0, 0.1))
    process.kill()
    process.communicate()
    whole.check(store)
    ingest(Store(store), lab / "lab/campaign.yaml")
    assert whole.content(store) == whole.content(lab / "after/store")
