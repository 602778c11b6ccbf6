"""What a query, damage or a closed pipe may do to a store: nothing, or a message."""

from __future__ import annotations

import errno
import os
import random
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from thermodata.view import StoreView

from .conftest import Lab
from .test_times import T1, rows, stamps


@pytest.fixture
def filled(lab: Lab) -> Lab:
    lab.write("raw/a.csv", "time;T\n" + rows(stamps("2026-03-02 08:00:00", 10, 200)))
    assert lab.ingest(T1).code == 0
    return lab


@pytest.mark.parametrize(
    "query",
    [
        "copy (select 1) to '{store}/catalog.duckdb'",
        "copy (select 1) TO '{store}/tidy/new.parquet' (format parquet)",
        "copy (select 1) to '{store}/../store/catalog.duckdb'",
        "copy (select 1) to '{link}/catalog.duckdb'",
        "copy (select 'to ''x.csv''' as a) /* to 'x.csv' */ to '{store}/x.csv'",
        "copy (select 1 as a) to '{store}/..' (format parquet, partition_by (a), overwrite true)",
        "explain analyze copy (select 1) to '{store}/catalog.duckdb'",
        "select 1; copy (select 1) to '{store}/catalog.duckdb'",
        "attach '{store}/catalog.duckdb' as c",
        "export database '{store}'",
        "copy from database memory to c",
        "copy test from '{store}/x.csv'",
        "install httpfs",
        "load httpfs",
        "set enable_profiling = 'json'",
        "pragma profiling_output = '{store}/catalog.duckdb'",
        "call enable_logging(storage = 'file', storage_path = '{store}')",
    ],
)
def test_a_query_writes_nothing_into_the_store(filled: Lab, query: str, tmp_path: Path) -> None:
    store = filled.folder / "store"
    (tmp_path / "link").symlink_to(store)
    before = {p: p.read_bytes() for p in store.rglob("*") if p.is_file() and p.suffix != ".lock"}
    said = filled("sql", query.format(store=store, link=tmp_path / "link"))
    assert said.code == 2, said
    assert {p: p.read_bytes() for p in store.rglob("*") if p.is_file() and p.suffix != ".lock"} == before
    assert filled("sql", "select count(*) as n from sample", "--csv").out == "n\n200\n"


def test_a_query_still_writes_files_of_its_own(filled: Lab, tmp_path: Path) -> None:
    assert filled("sql", f"copy (select value from sample) to '{tmp_path}/mine.csv' (header true)").code == 0
    assert (tmp_path / "mine.csv").read_text().count("\n") == 201


@pytest.mark.parametrize("how", [(), ("--csv",), ("--json",)])
def test_times_with_a_zone_need_no_other_package(filled: Lab, how: tuple[str, ...]) -> None:
    said = filled("sql", "select now() as t", *how)
    assert said.code == 0, said.err
    assert "20" in said.out


def test_no_extension_is_fetched(filled: Lab) -> None:
    query = "select name, value from duckdb_settings() where name like 'auto%_known_extensions' order by name"
    assert filled("sql", query, "--csv").out.count("false") == 2


def program(*words: object, **more: str) -> list[str]:
    return [sys.executable, "-m", "thermodata", *map(str, words)]


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_an_output_that_is_no_utf8_is_no_defect(filled: Lab, encoding: str) -> None:
    environment = {**os.environ, "PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"}
    for words in (("sql", "select '温度 µm' as a"), ("tests",), ("quality",)):
        done = subprocess.run(
            program("--store", filled.folder / "store", *words), env=environment, capture_output=True, timeout=60
        )
        assert done.returncode == 0, done.stderr
        assert b"defect" not in done.stderr


def test_a_closed_stdout_ends_in_a_message(filled: Lab) -> None:
    done = subprocess.run(
        ["sh", "-c", '"$@" >&-', "sh", *program("--store", filled.folder / "store", "tests")],
        capture_output=True,
        timeout=60,
    )
    assert b"Traceback" not in done.stderr
    assert b"defect" not in done.stderr


def test_a_line_of_50_megabytes_ends_in_a_message(lab: Lab) -> None:
    path = lab.write("raw/a.csv", b"time;T\n" + b"1" * 50_000_000)
    for command in ("sniff", "preview"):
        said = lab(command, path)
        assert "defect" not in said.err
        assert said.code in (0, 2, 3)


def test_a_query_does_not_answer_from_damaged_pages(filled: Lab) -> None:
    (tidy,) = (filled.folder / "store/tidy").glob("*.parquet")
    whole = tidy.read_bytes()
    sure = filled("sql", "select sum(value) as s, max(t_s) as t from sample", "--csv").out
    rng = random.Random(5)
    wrong = []
    for _ in range(60):
        at = rng.randrange(4, len(whole) - 8)
        tidy.write_bytes(whole[:at] + bytes([whole[at] ^ 1 << rng.randrange(8)]) + whole[at + 1 :])
        said = filled("sql", "select sum(value) as s, max(t_s) as t from sample", "--csv")
        assert "defect" not in said.err
        if said.code == 0 and said.out != sure:
            wrong.append(at)
        checked = filled("check")
        assert checked.code in (0, 4)
        assert "defect" not in checked.err
    assert wrong == []


def test_files_that_are_too_large_to_be_verified_are_said(filled: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    from thermodata.view.query import verify

    monkeypatch.setattr(verify, "_seen", set())
    view = StoreView(filled.folder / "store")
    with view.store.reader() as con:
        assert "thermodata check" in (verify.verify_pages(con, view.path, "from sample", most_bytes=10) or "")
        assert verify.verify_pages(con, view.path, "from sample") is None
        assert verify.verify_pages(con, view.path, "from test", most_bytes=0) is None


def test_a_column_name_with_a_flipped_bit_is_damage(filled: Lab) -> None:
    (tidy,) = (filled.folder / "store/tidy").glob("*.parquet")
    whole = tidy.read_bytes()
    at = whole.rindex(b"T1__flag")
    for letter in (0x80, 0x20):
        tidy.write_bytes(whole[:at] + bytes([whole[at] ^ letter]) + whole[at + 1 :])
        said = filled("check")
        assert "defect" not in said.err
        said = filled("sql", "from sample limit 1")
        assert "defect" not in said.err


def test_a_mount_that_cannot_be_written_is_looked_at_and_not_fitted(
    filled: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = filled.folder / "store"
    filled.write(
        "model.yaml",
        "schema: thermodata/model/1\nname: m\ncampaign: odd\nresponse: {channel: T1}\nstep: 60 s\n"
        "calibrate_on: [one]\neffects: [{effect: lag, drivers: {u: T1}}]\n",
    )

    def refused(path: object, *more: object, **options: object) -> None:
        raise OSError(errno.EROFS, "Read-only file system", str(path))

    made = Path.mkdir

    def mkdir(self: Path, *more: Any, **options: Any) -> None:
        if store in self.parents and not self.exists():
            refused(self)
        made(self, *more, **options)

    monkeypatch.setattr(os, "utime", refused)
    monkeypatch.setattr(Path, "mkdir", mkdir)
    for path in [*store.rglob("*"), store]:
        path.chmod(0o555 if path.is_dir() else 0o444)
    try:
        assert filled("tests").code == 0
        assert filled("sql", "from sample limit 1").code == 0
        said = filled("ingest", filled.folder / "campaign.yaml")
        assert said.code == 0
        assert "nothing changed" in said.out
        said = filled("fit", filled.folder / "model.yaml")
        assert said.code == 4, said.err
        assert "the store can only be read" in said.err
    finally:
        for path in [store, *store.rglob("*")]:
            path.chmod(0o755)


def test_a_mean_over_flagged_samples_is_said_and_valid_leaves_them_out(lab: Lab) -> None:
    cells = [f"{20 + i / 8}" if i != 77 else "562.0" for i in range(200)]
    stuck = ["---" if i in (90, 91) else c for i, c in enumerate(cells)]
    body = "".join(f"{t};{c}\n" for t, c in zip(stamps("2026-03-02 08:00:00", 10, 200), stuck, strict=True))
    lab.write("raw/a.csv", "time;T\n" + body)
    assert lab.ingest({"T1": {**T1["T1"], "sensor": {"range": ["0 degC", "100 degC"]}}}).code == 0
    query = "select count(*) as n, max(value) as most from {}"
    for view in ("sample", "temperature", "driver", "signal('odd', 'one', 'T1')"):
        said = lab("sql", query.format(view), "--csv")
        assert said.out == "n,most\n200,562.0\n"
        assert "'where valid(flag)' leaves out what does not count" in said.err
        valid = lab("sql", query.format(view) + " where valid(flag) and value is not null", "--csv")
        assert (valid.out, valid.err) == ("n,most\n197,44.875\n", "")
    assert lab("sql", query.format("displacement"), "--csv").out == "n,most\n0,\n"
    assert lab("sql", "from temperature limit 1").err == "", "who gets the flags sees them"
