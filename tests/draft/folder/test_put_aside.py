"""Pieces of one log that were put aside: the oldest first where nothing dates them, and packed ones are asked for."""

from __future__ import annotations

import bz2
import gzip
import lzma
from collections.abc import Callable
from pathlib import Path, PurePosixPath

import pytest

from tests.commands import Say
from thermodata.draft.make import draft_files
from thermodata.reader.files.rotated import age, unrotated
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

CAMPAIGN = """\
schema: thermodata/campaign/1
id: shop
machine: {id: x}
sources: {log: {reader: table}}
channels: {T_bed: {source: log, signal: "T_bed [degC]", quantity: temperature, at: bed}}
tests:
  - {id: warm, kind: other, role: calibration, files: {log: FILES}}
"""

ZSTANDARD = b"\x28\xb5\x2f\xfd" + bytes(40)


def piece(number: int) -> str:
    """Of 60 rows that count from 0, in which the temperature says which of the log they are."""
    return "t [s],T_bed [degC]\n" + "".join(f"{10 * i},{20 + number + i / 100:.2f}\n" for i in range(60))


def dated(hour: int) -> str:
    return "time,T_bed [degC]\n" + "".join(f"2026-03-02T{hour:02d}:{i:02d}:00Z,{20 + i / 100:.2f}\n" for i in range(60))


def test_the_pieces_of_one_log_from_the_oldest_on() -> None:
    names = ["a.log", "a.log.1", "a.log.10", "a.log.2"]
    assert sorted(names, key=lambda n: age(PurePosixPath(n))) == ["a.log.10", "a.log.2", "a.log.1", "a.log"]
    assert [unrotated(PurePosixPath(n)).name for n in ("a.log-20260403", "run.1", "V1.2.csv")] == [
        "a.log",
        "run.1",
        "V1.2.csv",
    ]


def test_the_backups_of_a_logger_are_pieces_of_its_table(tmp_path: Path) -> None:
    """LoggerNet puts a table's file aside where its header changed: here by a channel more."""
    names = ["a.dat.2.backup", "a.dat", "a.dat.backup", "a.dat.1.backup"]
    by_age = ["a.dat.backup", "a.dat.1.backup", "a.dat.2.backup", "a.dat"]
    assert sorted(names, key=lambda n: age(PurePosixPath(n))) == by_age
    assert {unrotated(PurePosixPath(n)).name for n in names} == {"a.dat"}
    for k, name in enumerate(by_age[1:]):
        of_nut = k > 1
        head = ["TIMESTAMP", "RECORD", "T_bed", *(["T_nut"] if of_nut else [])]
        units = ["TS", "RN", *["Deg C"] * (len(head) - 2)]
        rows = [[f"2026-03-02 {8 + k:02d}:{i:02d}:00", i, f"{20 + k + i / 100:.2f}", "21.5"] for i in range(60)]
        lines = [["TOA5", "CR", "CR1000"], head, units, ["", "", "Avg", "Avg"][: len(head)], *rows]
        text = "\n".join(",".join(f'"{c}"' for c in line[: len(head)]) for line in lines)
        (tmp_path / name).write_text(f"{text}\n")
    assert len(draft_files(tmp_path).draft.sources) == 1
    store = Store(tmp_path / "store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    with store.reader() as con:
        found = con.execute("select test, count(*), max(t_s) from sample where channel = 'T_bed' group by 1").fetchall()
    assert found == [("a", 180, 2 * 3600 + 59 * 60.0)]


def test_undated_pieces_are_asked_as_one_test_the_oldest_first(tmp_path: Path) -> None:
    for k, name in enumerate(("a.log.2", "a.log.1", "a.log")):
        (tmp_path / name).write_text(piece(k))
    (question,) = [q for s in draft_files(tmp_path).draft.sources for q in s.questions if "parts of one?" in q]
    assert "one test, a, with files: {log: [a.log.2, a.log.1, a.log]}" in question
    for k in range(3, 7):
        (tmp_path / f"a.log.{k}").write_text(piece(-k))
    (tmp_path / "campaign.yaml").unlink()
    (question,) = [q for s in draft_files(tmp_path).draft.sources for q in s.questions if "parts of one?" in q]
    assert 'with files: {log: "a.log*"}' in question


@pytest.mark.parametrize(
    ("files", "order"),
    [('"a.log*"', (2, 1, 0)), ("[a.log, a.log.2, a.log.1]", (0, 2, 1)), ("[a.log.1, a.log]", (1, 0))],
)
def test_undated_pieces_are_put_end_to_end_as_listed_or_the_oldest_first(
    tmp_path: Path, files: str, order: tuple[int, ...]
) -> None:
    for k, name in enumerate(("a.log", "a.log.1", "a.log.2")):
        (tmp_path / name).write_text(piece(k))
    store = Store(tmp_path / "store", create=True)
    for said in ('"a.log.*"', files):  # an order that is changed makes the test anew
        (tmp_path / "campaign.yaml").write_text(CAMPAIGN.replace("FILES", said))
        ingest(store, tmp_path / "campaign.yaml")
    with store.reader() as con:
        found = con.execute("select floor(value) from sample where t_s % 600 = 0 order by t_s").fetchall()
    assert [int(v) - 20 for (v,) in found] == list(order)


def test_a_packed_piece_of_a_log_is_asked_for(tmp_path: Path, say: Say) -> None:
    (tmp_path / "a.log").write_text(dated(10))
    (tmp_path / "a.log.1").write_text(dated(9))
    (tmp_path / "a.log.2.zst").write_bytes(ZSTANDARD)
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text()
    assert "'a.log.2.zst' is a piece of a.log too, packed and not read: unpack and draft again" in text


@pytest.mark.parametrize("read", ["log-20260302.csv", "log.csv", "log_2026-03-02.csv", "log.csv.1"])
def test_a_packed_log_whose_name_has_another_day_is_asked_for(tmp_path: Path, say: Say, read: str) -> None:
    (tmp_path / read).write_text(dated(10))
    for name in ("log-20260301.csv.zst", "log-20260228.csv.zst"):
        (tmp_path / name).write_bytes(ZSTANDARD)
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text()
    assert f"'log-20260228.csv.zst', 'log-20260301.csv.zst' are logs like {read}, packed and not read: unpack" in text


def test_a_packed_file_of_another_name_is_only_listed(tmp_path: Path, say: Say) -> None:
    (tmp_path / "log-20260302.csv").write_text(dated(10))
    (tmp_path / "photos-20260301.tar.gz").write_bytes(gzip.compress(b"x"))
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text()
    assert "packed and not read" not in text
    assert "# not used: photos-20260301.tar.gz" in text


def test_a_folder_of_nothing_but_packed_logs_says_to_unpack_them(tmp_path: Path, say: Say) -> None:
    (tmp_path / "log.csv.1.zst").write_bytes(ZSTANDARD)
    say("init", tmp_path)
    text = (tmp_path / "campaign.yaml").read_text()
    assert "? log.csv.1.zst is packed: unpack it and what is packed beside it" in text
    assert "what wrote" not in text


@pytest.mark.parametrize(("pack", "packer"), [(gzip.compress, "gzip"), (bz2.compress, "bzip2"), (lzma.compress, "xz")])
def test_an_ingest_says_that_a_file_is_packed(
    tmp_path: Path, say: Say, pack: Callable[[bytes], bytes], packer: str
) -> None:
    (tmp_path / "a.log").write_text(dated(10))
    (tmp_path / "a.log.1").write_bytes(pack(dated(9).encode()))
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN.replace("FILES", '"a.log*"'))
    said = say("--store", tmp_path / "store", "ingest", tmp_path / "campaign.yaml")
    assert said.code == 3
    assert "the file is packed; where: a.log.1" in said.out
    assert f"got: {packer}" in said.out
    assert "unpack it beside the others" in said.out
    assert "encoding" not in said.out
