"""Campaigns that grow: an ingest that changes nothing reads nothing, and files that are read side by side are the same
store, whatever ends the processes that read them."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.installed import look_at_readers_again
from thermodata.errors import FormatError, PluginError, QuestionError, StoreError, ThermodataError
from thermodata.plugin import Block, Loss, Source
from thermodata.reader.finding import registry
from thermodata.store import Store
from thermodata.store.ingest.reading import side_by_side, worker
from thermodata.store.ingest.run import ingest
from thermodata.store.ingest.summary import NOTHING, IngestSummary
from thermodata.store.raw import streams

sys.path.insert(0, str(Path(__file__).parents[1] / "hardening"))
import whole

TESTS = 6


pytestmark = pytest.mark.usefixtures("installed_readers")


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """A campaign file of six tests of two CSV files."""
    folder = tmp_path / "lab"
    (folder / "raw").mkdir(parents=True)
    for test in range(TESTS):
        for source, unit in (("a", "degC"), ("b", "rpm")):
            rows = "".join(f"{10 * i}.0,{20 + test + (i * 7919 % 13) / 10:.1f}\n" for i in range(40))
            (folder / "raw" / f"t{test}_{source}.csv").write_text(f"Time [s],x [{unit}]\n{rows}")
    (folder / "campaign.yaml").write_text(
        "schema: thermodata/campaign/1\nid: grown\nmachine: {id: m}\nsources:\n"
        + "".join(f"  {s}: {{reader: table, files: 'raw/{{test}}_{s}.csv'}}\n" for s in "ab")
        + "channels:\n  T_col: {source: a, signal: x, quantity: temperature, at: column.front}\n"
        + "  speed: {source: b, signal: x, quantity: rotational_speed, at: spindle}\n"
        + "tests:\n"
        + "".join(f"  - {{id: t{test}, kind: spindle, role: calibration}}\n" for test in range(TESTS))
    )
    return folder / "campaign.yaml"


def said(summary: IngestSummary) -> dict[str, Any]:
    """A summary without its time."""
    return {k: v for k, v in summary.to_json().items() if k != "seconds"}


def as_again(summary: IngestSummary) -> dict[str, Any]:
    """What the same ingest says the next time."""
    return said(summary) | {"changed": False, "read": 0, "made": 0, "stale": [], "notes": [*summary.notes, NOTHING]}


# ---- nothing has changed -------------------------------------------------------------------------


def test_an_ingest_looks_the_version_of_a_reader_up_once_whatever_the_number_of_files(
    store: Store, lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    look_at_readers_again()
    looked: list[str] = []
    right = registry.entry_points
    monkeypatch.setattr(registry, "entry_points", lambda **group: looked.append("x") or right(**group))
    ingest(store, lab)
    ingest(store, lab)
    assert len(looked) <= 2  # for what is installed, and for its versions


def test_an_ingest_that_changes_nothing_reads_nothing_and_says_the_same(
    store: Store, lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.ingest import layers, run
    from thermodata.store.ingest.known import unchanged
    from thermodata.store.ingest.reading import campaign_files

    monkeypatch.setattr(unchanged, "_YOUNG_NS", -(10**15))  # as if the files were written long ago
    first = ingest(store, lab)
    (store.path / "known" / note_of(store)).unlink()
    kept = ingest(store, lab)  # by the long way
    generation = store.generation

    def never(*_: Any, **__: Any) -> Any:
        raise AssertionError("the short way does not come here")

    for module, name in (
        (campaign_files, "settled"),
        (unchanged, "settled"),
        (layers, "bind"),
        (run, "read_inventory"),
    ):
        monkeypatch.setattr(module, name, never)
    assert said(ingest(store, lab)) == said(kept) == as_again(first)
    assert store.generation == generation


def test_the_short_way_is_taken_after_the_first_ingest_too(
    store: Store, lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.ingest import layers

    first = ingest(store, lab)
    monkeypatch.setattr(layers, "bind", None)
    assert said(ingest(store, lab)) == as_again(first)


def test_after_an_edit_only_what_was_edited_is_hashed_again(
    store: Store, lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.ingest.known import unchanged
    from thermodata.store.ingest.reading import campaign_files

    monkeypatch.setattr(unchanged, "_YOUNG_NS", -(10**15))  # as if the files were written long ago
    ingest(store, lab)
    edit(lab, store)
    hashed: list[str] = []
    right = campaign_files.settled
    monkeypatch.setattr(campaign_files, "settled", lambda path: hashed.append(path.name) or right(path))
    assert ingest(store, lab).read == 1
    assert hashed == ["t3_a.csv"]


def note_of(store: Store) -> str:
    """The name of the one note of a store."""
    (note,) = (store.path / "known").glob("*.json")
    return note.name


def edit(lab: Path, store: Store) -> None:
    path = lab.parent / "raw/t3_a.csv"
    path.write_text(path.read_text() + "400.0,21.5\n")


def edit_in_place(lab: Path, store: Store) -> None:
    """Another byte, and length and time as they were."""
    path = lab.parent / "raw/t3_a.csv"
    status, text = path.stat(), path.read_text()
    path.write_text(text[:-3] + ("9" if text[-3] != "9" else "8") + text[-2:])
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))


def add_file(lab: Path, store: Store) -> None:
    lab.write_text(lab.read_text().replace("{test}_a.csv", "{test}_a*.csv"))
    (lab.parent / "raw/t3_a2.csv").write_text("Time [s],x [degC]\n900.0,30.0\n910.0,30.1\n")


def remove_tidy_file(lab: Path, store: Store) -> None:
    next((store.path / "tidy").glob("*.parquet")).unlink()


def cut_raw_file(lab: Path, store: Store) -> None:
    path = next((store.path / "raw").glob("*.parquet"))
    path.write_bytes(path.read_bytes()[:-20])


def change_campaign(lab: Path, store: Store) -> None:
    lab.write_text(lab.read_text().replace("at: column.front", "at: column.rear"))


def forget_test(lab: Path, store: Store) -> None:
    from thermodata.store.keep.forget import forget

    forget(store, "grown", "t2")


@pytest.mark.parametrize(
    "change", [edit, edit_in_place, add_file, remove_tidy_file, cut_raw_file, change_campaign, forget_test]
)
def test_whatever_has_changed_is_seen(store: Store, lab: Path, change: Any) -> None:
    ingest(store, lab)
    assert not ingest(store, lab).changed
    change(lab, store)
    assert ingest(store, lab).changed
    assert whole.check(store.path)["sample"] > 0
    assert not ingest(store, lab).changed


def test_another_version_of_a_reader_is_seen(store: Store, lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ingest(store, lab)
    monkeypatch.setattr(registry, "_versions", lambda: {"table": "999.0"})
    monkeypatch.setattr(type(registry.reader("table")), "version", "999.0", raising=False)
    assert ingest(store, lab).read == 2 * TESTS


def test_a_torn_note_is_no_note(store: Store, lab: Path) -> None:
    first = ingest(store, lab)
    note = store.path / "known" / note_of(store)
    note.write_text(note.read_text().replace('"files": 12', '"files": 13'))
    assert said(ingest(store, lab)) == as_again(first)


def test_what_was_said_of_one_time_only_is_not_said_again(store: Store, lab: Path) -> None:
    ingest(store, lab)
    raw = lab.parent / "raw"
    lab.write_text(lab.read_text().replace("{test}_a.csv", "{test}_a*.csv"))
    ingest(store, lab)
    (raw / "t1_a.csv").rename(raw / "t1_a_renamed.csv")
    assert any("is raw/t1_a_renamed.csv now" in note for note in ingest(store, lab).notes)
    again = [ingest(store, lab).notes for _ in range(2)]
    assert again[0] == again[1]
    assert not any("is raw/t1_a_renamed.csv now" in note for note in again[0])


# ---- side by side --------------------------------------------------------------------------------


@pytest.fixture
def two_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("THERMODATA_WORKERS", "2")


def test_files_read_side_by_side_are_the_same_store(
    store: Store, lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (lab.parent / "raw/t4_b.csv").write_text("Time [s],x [rpm]\n0.0,7\nbroken\n10.0,8\n")
    (lab.parent / "raw/t5_b.csv").write_bytes(b"\x00\x01" * 40)
    alone = ingest(store, lab)
    monkeypatch.setenv("THERMODATA_WORKERS", "2")
    asked: list[str] = []
    right = worker.Task
    from thermodata.store.ingest.reading import campaign_files, raw_layer

    monkeypatch.setattr(campaign_files, "Task", lambda *words: asked.append(words[2]) or right(*words))
    monkeypatch.setattr(raw_layer, "read_raw", None)  # the ingest itself reads none
    other = Store(tmp_path / "other", create=True)
    together = ingest(other, lab)
    assert len(asked) == 2 * TESTS
    assert said(together) == said(alone)
    assert any(row["file"] == "raw/t5_b.csv" for row in together.losses)
    assert whole.content(other.path) == whole.content(store.path)
    files = {p.relative_to(store.path): p.read_bytes() for p in store.path.rglob("*.parquet")}
    assert {p.relative_to(other.path): p.read_bytes() for p in other.path.rglob("*.parquet")} == files


CRASHING = """
import os, signal
from thermodata_reader_table import Reader as TableReader
right = TableReader.blocks
def blocks(self, path, source):
    if path.name == "t2_a.csv":
        {how}
    yield from right(self, path, source)
TableReader.blocks = blocks
"""


def plugin(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, how: str) -> None:
    """A reader that does so with one of the files, in the workers only."""
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(CRASHING.format(how=how))
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "site"))


@pytest.mark.parametrize("how", ["os.kill(os.getpid(), signal.SIGKILL)", "os._exit(3)"])
def test_a_file_that_ends_its_process_is_a_loss_and_the_others_are_read(
    store: Store, lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, two_workers: None, how: str
) -> None:
    plugin(tmp_path, monkeypatch, how)
    summary = ingest(store, lab)
    (loss,) = [row for row in summary.losses if row["file"]]
    assert loss["file"] == "raw/t2_a.csv"
    assert "reading it ended the process" in loss["reason"]
    assert ("signal 9 (SIGKILL)" if "kill" in how else "exit code 3") in loss["reason"]
    assert summary.read == 2 * TESTS - 1
    whole.check(store.path)
    monkeypatch.delenv("PYTHONPATH")
    assert ingest(store, lab).losses == []


@pytest.mark.parametrize(
    ("how", "got"), [("raise RuntimeError('a bug')", "RuntimeError: a bug"), ("raise SystemExit(3)", "SystemExit: 3")]
)
def test_a_plugin_that_fails_in_a_worker_is_reported_as_ever(
    store: Store, lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, two_workers: None, how: str, got: str
) -> None:
    plugin(tmp_path, monkeypatch, f"print('to stdout'); {how}")
    summary = ingest(store, lab)
    (loss,) = [row for row in summary.losses if row["file"]]
    assert loss["file"] == "raw/t2_a.csv"
    assert "reader 'table' failed" in loss["reason"]
    assert got in loss["reason"]
    assert summary.read == 2 * TESTS - 1


def test_a_plugin_that_says_sys_exit_ends_neither_the_ingest_nor_what_it_reads_beside_it(
    store: Store, lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata_reader_table import Reader as TableReader

    right = TableReader.blocks

    def blocks(self: TableReader, path: Path, source: Source) -> Iterator[Block | Loss]:
        if path.name == "t2_a.csv":
            sys.exit(3)
        yield from right(self, path, source)

    monkeypatch.setattr(TableReader, "blocks", blocks)
    summary = ingest(store, lab)
    (loss,) = [row for row in summary.losses if row["file"]]
    assert loss["file"] == "raw/t2_a.csv"
    assert "reader 'table' failed" in loss["reason"]
    assert "SystemExit: 3" in loss["reason"]
    assert summary.read == 2 * TESTS - 1


def test_workers_that_cannot_be_started_leave_the_reading_to_the_ingest(
    store: Store, lab: Path, monkeypatch: pytest.MonkeyPatch, two_workers: None
) -> None:
    monkeypatch.setattr(side_by_side, "_START", "raise SystemExit(1)")
    summary = ingest(store, lab)
    assert (summary.losses, summary.read) == ([], 2 * TESTS)


def test_a_full_disk_in_a_worker_is_an_error_with_what_is_needed(
    store: Store, lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, two_workers: None
) -> None:
    plugin(tmp_path, monkeypatch, "from thermodata.errors import NoRoomError; raise NoRoomError('the disk is full')")
    with pytest.raises(StoreError, match="the disk is full") as error:
        ingest(store, lab)
    assert error.value.expected == "about 1 MB for raw/t2_a.csv"
    assert whole.check(store.path)["sample"] == 0


SLOW = "import time; print('begun', flush=True); time.sleep(3600)"
# a disk that takes its time while a finished file is written to it, and hears of no signal
STUCK = "import thermodata.store.raw.writer as w; w.publish = lambda *_: stuck()"
STUCK_FOR = """
def stuck():
    import time
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    print('begun', flush=True)
    time.sleep(3600)
"""


@pytest.mark.parametrize(("kind", "at"), [(signal.SIGKILL, SLOW), (signal.SIGINT, SLOW), (signal.SIGKILL, STUCK)])
def test_an_ingest_that_is_ended_ends_its_workers_and_leaves_the_store_as_it_was(
    store: Store,
    lab: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    two_workers: None,
    kind: signal.Signals,
    at: str,
) -> None:
    plugin(tmp_path, monkeypatch, at)
    with (tmp_path / "site" / "sitecustomize.py").open("a") as more:
        more.write(STUCK_FOR)
    child = subprocess.Popen(
        [sys.executable, "-m", "thermodata", "--store", str(store.path), "ingest", str(lab)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        # who starts a test in the background of a shell hands it an ignored SIGINT
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        text=True,
    )
    assert child.stderr is not None
    for line in child.stderr:  # what a reader prints, of a worker too, is talk
        if "begun" in line:
            break
    mine = workers_of(child.pid)
    assert len(mine) == 2
    child.send_signal(kind)
    child.wait(300)
    deadline = time.monotonic() + 300
    while (left := [pid for pid in mine if alive(pid)]) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert left == []
    child.stderr.close()
    assert whole.check(store.path)["sample"] == 0
    assert [p.name for p in (store.path / "raw").iterdir() if p.suffix == ".tmp"] == []
    monkeypatch.delenv("PYTHONPATH")
    assert ingest(store, lab).losses == []


def workers_of(pid: int) -> list[int]:
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                parent = int((entry / "stat").read_text().rpartition(")")[2].split()[1])
            except OSError:
                continue
            if parent == pid:
                found.append(int(entry.name))
    return found


def alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_workers_are_started_only_where_they_pay_and_there_is_room(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("THERMODATA_WORKERS", raising=False)
    monkeypatch.setattr(side_by_side, "_cores", lambda: 16)
    monkeypatch.setattr(side_by_side, "_available", lambda: 64 << 30)
    assert side_by_side.workers_for(20, 1_000_000) == 0
    assert side_by_side.workers_for(1, 10**12) == 0
    assert side_by_side.workers_for(2, 10**12) == 2
    assert side_by_side.workers_for(2000, 1_000_000) == side_by_side.MOST
    monkeypatch.setattr(side_by_side, "_available", lambda: 3 << 30)
    assert side_by_side.workers_for(2000, 1_000_000) == 3
    monkeypatch.setattr(side_by_side, "_available", lambda: 1 << 30)
    assert side_by_side.workers_for(2000, 1_000_000) == 0
    monkeypatch.setattr(side_by_side, "_cores", lambda: 1)
    assert side_by_side.workers_for(2000, 1_000_000) == 0


def test_few_files_are_hashed_ahead_of_the_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    """However many files there are, a few are in the works: what waits does not grow."""

    class Pool:
        def __init__(self, workers: int) -> None:
            from queue import SimpleQueue

            self.answers: Any = SimpleQueue()
            self.most = self.waiting = 0
            self.tasks, self.ended = self, False

        def put(self, task: Any) -> None:
            self.waiting += 1
            self.most = max(self.most, self.waiting)
            self.answers.put((task, worker.Done(None)))

        def end(self) -> None:
            self.ended = True

    pool = Pool(2)
    monkeypatch.setattr(side_by_side, "_Pool", lambda workers: pool)
    for _ in side_by_side.read_side_by_side(iter(range(50)), 2, lambda n: None):  # type: ignore[arg-type]
        pool.waiting -= 1
    assert pool.most <= 4
    assert pool.ended, "no worker stays behind"


@pytest.mark.parametrize(
    "error",
    [
        FormatError("wrong", where="x.csv row 3", expected="a", got="b", hint="c"),
        PluginError("a bug"),
        QuestionError("which", ask="?", declare={"time": {"unit": "unknown"}}, meanwhile={}, where="x"),
        StoreError("the disk is full", where="x"),
    ],
)
def test_an_error_from_another_process_is_what_it_was(error: ThermodataError) -> None:
    there = pickle.loads(pickle.dumps(error))
    assert (type(there), str(there), vars(there)) == (type(error), str(error), vars(error))


def test_a_worker_with_another_reader_leaves_the_file_to_who_asked(tmp_path: Path) -> None:
    path = tmp_path / "x.csv"
    path.write_text("Time [s],x [degC]\n0,1\n1,2\n")
    from thermodata.store.raw.source_file import settled

    task = worker.Task("another key", tmp_path, "x.csv", settled(path), "table", Source())
    assert worker.read(task, lambda samples: None).streams is None
    assert not (tmp_path / "raw").exists()
    key = streams.raw_key(task.file.sha256, registry.reader("table"), Source())
    known = worker.read(worker.Task(key, tmp_path, "x.csv", task.file, "table", Source()), lambda samples: None)
    assert isinstance(known.streams, list)


def test_a_channel_of_long_tests_is_a_branch_of_its_own_and_says_the_same(
    store: Store, lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.views import long

    ingest(store, lab)

    def answers() -> list[Any]:
        with store.reader() as con:
            queries = [f"select * from {view} order by all" for view in ("sample", "temperature", "driver")]
            return [con.execute(q).fetchall() for q in queries] + [
                con.execute("describe sample").fetchall(),
                con.execute("select test, avg(value) from sample where channel = 'speed' group by all").fetchall(),
            ]

    def text() -> str:
        with store.reader() as con:
            return str(con.execute("select sql from duckdb_views() where view_name = 'sample'").fetchall())

    together = answers()
    assert "CROSS JOIN" in text().upper()
    monkeypatch.setattr(long, "_LONG_ROWS", 1)
    with store.write() as con:
        con.execute("select 1")  # a commit of nothing makes the views anew
    assert "CROSS JOIN" not in text().upper()
    apart = answers()
    assert apart[:-1] == together[:-1]
    assert sorted(apart[-1]) == sorted(together[-1])
    assert len(together[0]) == 2 * 40 * TESTS
