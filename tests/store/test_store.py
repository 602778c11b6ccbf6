"""The store itself: turns at the catalogue, copies, formats, damage, and being moved about."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from store_fakes import daq, write_campaign, write_log

from thermodata.errors import StoreError, UsageError
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.keep.gc import gc

WORKER = Path(__file__).parent / "worker.py"


def worker(*arguments: object) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, str(WORKER), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def count(store: Store, what: str) -> int:
    with store.reader() as con:
        found = con.execute(f"select count(*) from {what}").fetchone()
    assert found is not None
    return int(found[0])


def test_a_missing_store_is_a_usage_error_that_says_how_to_make_one(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="ingest"):
        Store(tmp_path / "nowhere")
    assert not (tmp_path / "nowhere").exists()


def test_a_reader_keeps_its_copy_while_a_writer_commits(filled: Store) -> None:
    with filled.reader() as con:
        before = con.execute("select count(*) from test").fetchone()
        with Store(filled.path).write() as other:
            other.execute("delete from test where test = 'one'")
        assert con.execute("select count(*) from test").fetchone() == before == (2,)
    assert count(filled, "test") == 1


def test_a_failed_write_leaves_everything_as_it_was(filled: Store) -> None:
    def half_way() -> None:
        with filled.write() as con:
            con.execute("delete from test")
            raise RuntimeError("half way")

    with pytest.raises(RuntimeError, match="half way"):
        half_way()
    assert count(filled, "test") == 2
    assert count(Store(filled.path), "test") == 2


def test_views_and_macros_are_in_the_copy(filled: Store) -> None:
    with filled.reader() as con:
        assert con.execute("select count(*) from signal('shop', 'one', 'dZ')").fetchone() == (1200,)
        assert con.execute("select count(*) from sample where test = 'one' and channel = 'T_a'").fetchone() == (1200,)
        assert con.execute("select current_setting('asof_loop_join_threshold')::int").fetchone() == (0,)


def test_a_moved_store_works(filled: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    moved = tmp_path / "ein anderer 'Ort'"
    shutil.move(filled.path, moved)
    monkeypatch.chdir("/")
    store = Store(moved)
    assert count(store, "sample") == 7460
    assert ingest(store, tmp_path / "lab/campaign.yaml").changed is False


def test_duckdb_alone_opens_the_catalogue_from_inside_the_folder(filled: Store) -> None:
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            "import duckdb; print(duckdb.connect('catalog.duckdb', read_only=True)"
            ".execute('select count(*) from displacement').fetchone())",
        ],
        cwd=filled.path,
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "(2400,)"


def test_a_newer_store_is_refused_with_the_format_needed(filled: Store) -> None:
    with filled.write() as con:
        con.execute("update store set format = 99, created_by = 'thermodata 9.9'")
    for attempt in (lambda: count(Store(filled.path), "test"), lambda: Store(filled.path).write().__enter__()):
        with pytest.raises(StoreError, match=r"99.*9\.9") as error:
            attempt()
        assert error.value.exit_code == 4


@pytest.mark.parametrize("harm", ["garbage", "cut", "empty"])
def test_a_damaged_catalogue_is_a_store_error(filled: Store, harm: str) -> None:
    path = filled.path / "catalog.duckdb"
    data = path.read_bytes()
    path.write_bytes({"garbage": b"no database" * 1000, "cut": data[:4096], "empty": b"x"}[harm])
    with pytest.raises(StoreError) as error:
        count(Store(filled.path), "test")
    assert error.value.where is not None
    assert "catalog.duckdb" in error.value.where


def test_a_process_that_was_stopped_while_it_waited_did_not_wait(
    filled: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.catalogue import lock

    now, looks = [0.0], [0]

    def busy_twice(fd: int, exclusive: bool) -> bool:
        looks[0] += 1
        now[0] += 3600.0  # stopped between two looks
        return looks[0] > 2

    monkeypatch.setattr(lock, "_try_lock", busy_twice)
    monkeypatch.setattr(lock.time, "monotonic", lambda: now[0])
    with lock.catalogue_lock(filled.path, exclusive=True, timeout_s=60.0):
        assert looks[0] == 4  # the turnstile at the third look, and the catalogue at once


def test_a_busy_store_says_so_after_its_timeout(filled: Store) -> None:
    impatient = Store(filled.path, timeout_s=0.2)
    with filled.write() as con:
        con.execute("select 1")
        with pytest.raises(StoreError, match="busy"):
            impatient.private_copy()


def test_writers_and_readers_at_once(filled: Store) -> None:
    """Each write is counted once, and none starves beside readers that never pause."""
    stop, failures = threading.Event(), []
    start = count(filled, "locked_look")

    def write(n: int) -> None:
        try:
            store = Store(filled.path)
            for _ in range(n):
                with store.write() as con:
                    con.execute("insert into locked_look values ('shop', 'one', 'm', 'r', now())")
        except Exception as error:
            failures.append(error)

    def read() -> None:
        try:
            while not stop.is_set():
                Store(filled.path).private_copy().close()
        except Exception as error:
            failures.append(error)

    writers = [threading.Thread(target=write, args=(3,)) for _ in range(2)]
    readers = [threading.Thread(target=read) for _ in range(2)]
    for thread in (*readers, *writers):
        thread.start()
    for thread in writers:
        thread.join(30)
    stop.set()
    for thread in readers:
        thread.join(30)
    assert failures == []
    assert count(filled, "locked_look") == start + 6


def test_two_processes_ingest_while_one_reads(tmp_path: Path) -> None:
    store = Store(tmp_path / "store", create=True)
    first = write_campaign(tmp_path / "a")
    text = first.read_text().replace("id: shop", "id: other")
    second = write_campaign(tmp_path / "b", text)
    running = [
        worker("ingest", store.path, first),
        worker("ingest", store.path, second),
        worker("read", store.path, 2),
    ]
    try:
        for process in running:
            out, err = process.communicate(timeout=60)
            assert process.returncode == 0, out + err
    finally:
        for process in running:
            process.kill()  # one reads until both campaigns are there, which may be never
    assert count(store, "campaign") == 2
    assert count(store, "sample") == 2 * 7460


def test_kill_9_at_any_moment_leaves_a_store_that_works(tmp_path: Path) -> None:
    campaign = write_campaign(tmp_path / "lab", logs=False)
    for i, test in enumerate(("one", "two")):
        write_log(campaign.parent / f"raw/{test}_a.npz", daq(5_000, seed=i))
    whole = Store(tmp_path / "whole", create=True)
    ingest(whole, campaign)
    expected = count(whole, "sample")
    for delay in (0.0, 0.05, 0.15):
        folder = tmp_path / f"store{delay}"
        process = worker("ingest", folder, campaign)
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(delay)
        process.send_signal(signal.SIGKILL)
        process.wait()
        store = Store(folder)
        assert count(store, "sample") in (0, expected)  # nothing by halves
        ingest(store, campaign)
        assert count(store, "sample") == expected
        gc(store, grace_s=0)
        assert not [p for p in folder.rglob("*") if p.name.endswith(".tmp")]
        assert count(store, "sample") == expected


def test_a_path_with_a_comma_is_refused_with_the_reason(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="comma"):
        Store(tmp_path / "a,b", create=True)


def test_a_full_disk_is_a_store_error_and_leaves_nothing(
    store: Store, campaign: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import pyarrow.parquet as pq

    def full(*args: object, **kwargs: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(pq.ParquetWriter, "write_table", full)
    with pytest.raises(StoreError, match="No space left"):
        ingest(store, campaign)
    assert count(store, "test") == 0
    assert not list(store.path.rglob("*.tmp"))


def test_a_missing_parquet_file_is_made_again(filled: Store, campaign: Path) -> None:
    for path in filled.path.rglob("*.parquet"):
        path.unlink()
    assert ingest(filled, campaign).losses == []
    assert count(filled, "sample") == 7460
