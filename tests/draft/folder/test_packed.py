"""Logs that somebody packed: each alone, or a day's in an archive; and what an untrusted archive may hold."""

from __future__ import annotations

import bz2
import gzip
import hashlib
import io
import lzma
import struct
import tarfile
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.commands import Say
from thermodata.archive import too_much, unpacked
from thermodata.draft.make import draft_files
from thermodata.errors import FormatError
from thermodata.plugin import Head, Source
from thermodata.reader.contract.guard import described
from thermodata.reader.finding.registry import reader
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.trace.lineage import trace


def log(day: int, warm: float = 20.0) -> str:
    rows = (f"2026-03-{day:02d}T08:{i:02d}:00Z,{warm + i / 100:.2f},{3000 if i > 9 else 0}\n" for i in range(60))
    return "time,T_bed [degC],n [rpm]\n" + "".join(rows)


def zipped(path: Path, files: dict[str, str | bytes]) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return path


def rows_of(folder: Path, say: Say) -> list[Any]:
    """The samples of a drafted folder, ingested."""
    assert say("init", folder).code == 0
    store = Store(folder.parent / f"{folder.name}.store", create=True)
    summary = ingest(store, folder / "campaign.yaml")
    assert not summary.losses
    again = ingest(store, folder / "campaign.yaml")
    assert any("nothing changed" in note for note in again.notes)
    with store.reader() as con:
        return con.execute("select test, channel, t, value, flag from sample order by all").fetchall()


@pytest.fixture(autouse=True)
def _nothing_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    (tmp_path / "tmp").mkdir()
    unpacked.forget_unpacked()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "tmp"))
    yield
    unpacked.forget_unpacked()
    assert not list((tmp_path / "tmp").iterdir())


def test_packed_logs_are_those_that_were_packed(tmp_path: Path, say: Say) -> None:
    texts = {f"heat{k}.csv": log(k, 20 + k) for k in (1, 2, 3)}
    for name in ("loose", "gz", "bz2", "xz", "mixed"):
        (tmp_path / name).mkdir()
    for name, text in texts.items():
        (tmp_path / "loose" / name).write_text(text)
        (tmp_path / "gz" / f"{name}.gz").write_bytes(gzip.compress(text.encode()))
        (tmp_path / "bz2" / f"{name}.bz2").write_bytes(bz2.compress(text.encode()))
        half = len(text) // 2  # as pixz and 'cat' have it, several streams
        streams = [lzma.compress(part) for part in (text[:half].encode(), text[half:].encode())]
        (tmp_path / "xz" / f"{name}.xz").write_bytes(streams[0] + bytes(8) + streams[1])
    (tmp_path / "mixed/heat1.csv").write_text(texts["heat1.csv"])
    for name in ("heat2.csv", "heat3.csv"):
        (tmp_path / "mixed" / f"{name}.gz").write_bytes(gzip.compress(texts[name].encode()))
    zipped(tmp_path / "one" / "march.zip", dict(texts))
    for name in ("march.tar", "march.tar.gz", "march.tgz", "march.tbz2", "march.tar.xz"):
        tarred(tmp_path / f"one_{name}" / name, dict(texts))
    for name, text in texts.items():
        tarred(tmp_path / "each_tar" / f"{name[:5]}.tar.gz", {"./log.csv": text})
        zipped(tmp_path / "each" / f"{name[:5]}.zip", {"log.csv": text})
    loose = rows_of(tmp_path / "loose", say)
    assert len(loose) == 360
    assert {test for test, *_ in loose} == {"heat1", "heat2", "heat3"}
    others = sorted(p.name for p in tmp_path.iterdir() if p.is_dir() and p.name not in ("tmp", "loose", "loose.store"))
    assert len(others) == 12
    for name in others:
        assert rows_of(tmp_path / name, say) == loose, name


def test_the_files_of_an_archive_are_sources_and_parts_as_in_a_folder(tmp_path: Path, say: Say) -> None:
    for k in (1, 2, 3):
        hall = log(k).replace("T_bed", "T_hall").replace(",n [rpm]", ",T_floor [degC]")
        zipped(tmp_path / "lab" / f"day{k}.zip", {"machine.csv": log(k), "hall.csv": hall})
    rows = rows_of(tmp_path / "lab", say)
    assert {(test, channel) for test, channel, *_ in rows} == {
        (f"day{k}", channel) for k in (1, 2, 3) for channel in ("T_bed", "n", "T_hall", "T_floor")
    }


def test_a_packed_log_goes_by_the_checksum_of_its_file_and_one_of_an_archive_by_its_own(
    tmp_path: Path, say: Say
) -> None:
    whole = gzip.compress(log(1).encode())
    (tmp_path / "lab").mkdir()
    (tmp_path / "lab/heat1.csv.gz").write_bytes(whole)
    archive = zipped(tmp_path / "lab/more.zip", {"heat2.csv": log(2), "heat3.csv": log(3)})
    before = archive.read_bytes()
    rows_of(tmp_path / "lab", say)
    assert (tmp_path / "lab/heat1.csv.gz").read_bytes() == whole
    assert archive.read_bytes() == before
    store = Store(tmp_path / "lab.store")
    with store.reader() as con:
        found = dict(con.execute("select source_path, sha256 from file where layer = 'raw'").fetchall())
    assert found == {
        "heat1.csv.gz": hashlib.sha256(whole).hexdigest(),
        "more.zip/heat2.csv": hashlib.sha256(log(2).encode()).hexdigest(),
        "more.zip/heat3.csv": hashlib.sha256(log(3).encode()).hexdigest(),
    }
    for test in ("heat1", "heat3"):
        raw = trace(store, "lab", test, "T_bed", 600.0, verify=True)["sample"]["raw"]
        assert raw["again"]["file"] == "unchanged"
        assert raw["again"]["value"] == raw["raw_value"]
        assert raw["again"]["place"] == "line 12"


def test_a_log_more_in_an_archive_leaves_the_others_as_they_are_and_is_told(tmp_path: Path, say: Say) -> None:
    archive = zipped(tmp_path / "lab/march.zip", {"heat2.csv": log(2), "heat3.csv": log(3)})
    rows_of(tmp_path / "lab", say)
    zipped(archive, {"heat2.csv": log(2), "heat3.csv": log(3), "heat4.csv": log(4)})
    summary = ingest(Store(tmp_path / "lab.store"), tmp_path / "lab/campaign.yaml")
    assert summary.read == 0
    assert "in no test, though called as the sources say: march.zip/heat4.csv" in "".join(summary.notes)


def test_what_lies_beside_what_it_was_packed_of_is_a_copy(tmp_path: Path, say: Say) -> None:
    lab = tmp_path / "lab"
    (lab / "day1").mkdir(parents=True)
    for k in (1, 2):
        (lab / f"day1/heat{k}.csv").write_text(log(k))
    zipped(lab / "day1.zip", {"heat1.csv": log(1), "heat2.csv": log(2)})
    (lab / "day1/heat2.csv.gz").write_bytes(gzip.compress(log(2).encode()))
    (lab / "day1/heat1.csv.gz").write_bytes(gzip.compress(log(3).encode()))  # another one
    draft = draft_files(lab).draft
    assert {p for p, why in draft.not_used if "a copy of" in why} == {
        "day1.zip",
        "day1/heat2.csv.gz",
    }


def test_a_log_that_was_packed_twice_is_one(tmp_path: Path) -> None:
    texts = {f"heat{k}.csv": log(k) for k in (1, 2)}
    for name, text in texts.items():
        written(tmp_path / "mixed" / f"{name}.gz", gzip.compress(text.encode()))
        written(tmp_path / "mixed" / f"{name}.xz", lzma.compress(text.encode()))
    tarred(tmp_path / "mixed/day.tar", dict(texts))
    zipped(tmp_path / "both/day.zip", dict(texts))
    tarred(tmp_path / "both/day.tar.gz", dict(texts))
    zipped(tmp_path / "both/first.zip", {"heat1.csv": texts["heat1.csv"]})
    for name, copies in (
        ("mixed", {"day.tar", "heat1.csv.xz", "heat2.csv.xz"}),
        ("both", {"day.zip", "first.zip/heat1.csv"}),
    ):
        draft = draft_files(tmp_path / name).draft
        assert [t.id for t in draft.tests] == ["heat1", "heat2"]
        assert {p for p, why in draft.not_used if "a copy of" in why} == copies


def test_what_two_archives_share_in_part_is_told_and_read_once(tmp_path: Path) -> None:
    texts = {f"heat{k}.csv": log(k) for k in (1, 2, 3, 4)}
    zipped(tmp_path / "day.zip", {n: texts[n] for n in ("heat3.csv", "heat4.csv")})
    zipped(tmp_path / "week.zip", {n: texts[n] for n in ("heat1.csv", "heat2.csv", "heat3.csv")})
    draft = draft_files(tmp_path).draft
    assert sorted(t.id for t in draft.tests) == ["heat1", "heat2", "heat3", "heat4"]
    assert {p for p, why in draft.not_used if "a copy of" in why} == {"day.zip/heat3.csv"}
    summary = ingest(Store(tmp_path / "store", create=True), tmp_path / "campaign.yaml")
    assert (summary.read, summary.losses) == (4, [])
    assert not any("hold the same recording" in note for note in summary.notes)


def test_archives_with_another_file_of_one_name_share_none(tmp_path: Path) -> None:
    zipped(tmp_path / "one.zip", {"probe1.csv": log(1), "probe2.csv": log(2), "a.csv": log(5)})
    zipped(tmp_path / "two.zip", {"probe1.csv": log(1), "probe2.csv": log(3), "b.csv": log(6)})
    assert not [p for p, why in draft_files(tmp_path).draft.not_used if "a copy of" in why]


def test_a_log_that_two_archives_of_other_tests_share_is_one_of_each(tmp_path: Path) -> None:
    told = "time [s],n [rpm]\n" + "".join(f"{60 * i},{3000 if i > 9 else 0}\n" for i in range(60))
    for k in (1, 2):
        zipped(tmp_path / f"heat{k}.zip", {"temperatures.csv": log(k), "speed.csv": told})
    assert not [p for p, why in draft_files(tmp_path).draft.not_used if "a copy of" in why]


def test_archives_that_hold_no_log_are_a_line_each(tmp_path: Path) -> None:
    (tmp_path / "heat1.csv").write_text(log(1))
    zipped(tmp_path / "photos.zip", {f"p{i}.jpg": b"\xff\xd8\xff" + bytes(20) for i in range(40)})
    (said,) = [(p, why) for p, why in draft_files(tmp_path).draft.not_used if p.startswith("photos")]
    assert said[0] == "photos.zip"
    assert said[1].startswith(
        "no file in it is read as a log (p0.jpg, p1.jpg, p2.jpg and 37 more): no reader claims it"
    )


def locked(path: Path) -> Path:
    """An archive whose file says that it is encrypted."""
    data = bytearray(zipped(path, {"heat1.csv": log(1)}).read_bytes())
    for magic, at in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        where = data.index(magic) + at
        data[where : where + 2] = struct.pack("<H", 1)
    path.write_bytes(bytes(data))
    return path


WAYS = {".gz": "w:gz", ".tgz": "w:gz", ".tbz2": "w:bz2", ".xz": "w:xz"}
BAD: dict[str, tuple[Callable[[Path], Path], str]] = {
    "leads out": (lambda p: zipped(p / "a.zip", {"../heat1.csv": log(1)}), "its name leads elsewhere"),
    "absolute": (lambda p: zipped(p / "a.zip", {"/etc/heat1.csv": log(1)}), "its name leads elsewhere"),
    "drive": (lambda p: zipped(p / "a.zip", {"C:\\heat1.csv": log(1)}), "its name leads elsewhere"),
    "encrypted": (lambda p: locked(p / "a.zip"), "it is encrypted"),
    "nested": (
        lambda p: zipped(p / "a.zip", {"b.zip": zipped(p / "tmp/b.zip", {"heat1.csv": log(1)}).read_bytes()}),
        "packed more than once",
    ),
    "gz in a zip": (
        lambda p: zipped(p / "a.zip", {"b.csv.gz": gzip.compress(log(1).encode())}),
        "packed more than once",
    ),
    "bomb": (lambda p: zipped(p / "a.zip", {"heat1.csv": bytes(4_000_000)}), "unpacks to more than logs do"),
    "cut": (lambda p: cut(zipped(p / "a.zip", {"heat1.csv": log(1)})), "an archive that can't be read"),
    "gz bomb": (lambda p: written(p / "a.csv.gz", gzip.compress(bytes(4_000_000))), "unpacks to more than a log does"),
    "gz cut at its head": (
        lambda p: written(p / "a.csv.gz", gzip.compress(log(1).encode())[:14]),
        "a packed file that is damaged",
    ),
    "tar leads out": (lambda p: tarred(p / "a.tar.gz", {"../heat1.csv": log(1)}), "its name leads elsewhere"),
    "tar link": (lambda p: linked(p / "a.tgz"), "it is a link, or no plain file"),
    "tar bomb": (lambda p: tarred(p / "a.tgz", {"heat1.csv": "0" * 4_000_000}), "unpacks to more than logs do"),
    "tar cut": (lambda p: written(p / "a.tar", entry("heat1.csv")[:500]), "an archive that can't be read"),
    "tar of a zip": (
        lambda p: tarred(p / "a.tar", {"b.csv.gz": gzip.compress(log(1).encode())}),
        "packed more than once",
    ),
    "xz of much memory": (
        lambda p: written(
            p / "a.csv.xz", lzma.compress(log(1).encode(), filters=[{"id": lzma.FILTER_LZMA2, "dict_size": 1 << 29}])
        ),
        "a packed file that is damaged",
    ),
    "7z": (lambda p: written(p / "a.7z", b"7z\xbc\xaf\x27\x1c" + bytes(60)), "7z x a.7z"),
    "gz wrong": (
        lambda p: written(p / "a.csv.gz", gzip.compress(log(1).encode())[:-8] + bytes(8)),
        "a packed file that is damaged",
    ),
    "gz twice": (
        lambda p: written(p / "a.csv.gz", gzip.compress(gzip.compress(log(1).encode()))),
        "packed more than once",
    ),
}


def tarred(path: Path, files: dict[str, str | bytes]) -> Path:
    """An archive, packed as its name says."""
    path.parent.mkdir(parents=True, exist_ok=True)
    way: Any = WAYS.get(path.suffix, "w")
    with tarfile.open(path, way) as archive:
        for name, content in files.items():
            data = content.encode() if isinstance(content, str) else content
            member = tarfile.TarInfo(name)
            member.size = len(data)
            archive.addfile(member, io.BytesIO(data))
    return path


def entry(name: str) -> bytes:
    """A log as a TAR archive has it, without an end mark."""
    data = log(1).encode()
    member = tarfile.TarInfo(name)
    member.size = len(data)
    return member.tobuf(tarfile.GNU_FORMAT) + data + bytes(-len(data) % 512)


def linked(path: Path) -> Path:
    """An archive of a name that stands for another file."""
    with tarfile.open(path, "w:gz") as archive:
        member = tarfile.TarInfo("heat1.csv")
        member.type, member.linkname = tarfile.SYMTYPE, "/etc/passwd"
        archive.addfile(member)
    return path


def written(path: Path, data: bytes) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
    return path


def cut(path: Path) -> Path:
    return written(path, path.read_bytes()[:-30])


@pytest.mark.parametrize("kind", BAD)
def test_what_an_archive_may_not_hold_is_refused_with_a_sentence(
    tmp_path: Path, say: Say, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    monkeypatch.setattr(too_much, "_SMALL", 1_000_000)
    make, why = BAD[kind]
    (tmp_path / "lab").mkdir()
    path = make(tmp_path / "lab")
    for other in (tmp_path / "lab/tmp").glob("*"):
        other.unlink()
    (tmp_path / "lab/heat9.csv").write_text(log(9))
    assert say("init", tmp_path / "lab").code == 0
    assert why in (tmp_path / "lab/campaign.yaml").read_text()
    sniffed = say("sniff", path)
    assert sniffed.code == 2
    assert why in sniffed.out
    with pytest.raises((FormatError, FileNotFoundError)):
        described(reader("table"), path, Source())


def test_a_named_archive_of_several_logs_asks_for_one_and_of_one_log_is_that(tmp_path: Path) -> None:
    several = zipped(tmp_path / "a.zip", {"heat1.csv": log(1), "heat2.csv": log(2)})
    with pytest.raises(FormatError, match="an archive of several files") as refused:
        described(reader("table"), several, Source())
    assert refused.value.hint == "name what is in it: files: 'a.zip/*', or 'a.zip/heat1.csv'"
    one = zipped(tmp_path / "b.zip", {"heat1.csv": log(1), "__MACOSX/._heat1.csv": b"\0"})
    assert len(described(reader("table"), one, Source()).signals) == 2


def test_a_reader_whose_own_format_is_packed_gets_it_as_it_is(tmp_path: Path) -> None:
    class Vendor:
        name = "vendor"

        def sniff(self, head: Head) -> str | None:
            return "its archive" if b"vendor.ini" in head.start else None

        def describe(self, path: Path, source: Source) -> Any:
            raise FormatError(path.name)

        def blocks(self, path: Path, source: Source) -> Any:
            raise NotImplementedError

    path = zipped(tmp_path / "run.zip", {"vendor.ini": "x", "data.csv": log(1)})
    with pytest.raises(FormatError, match=r"^run\.zip"):
        described(Vendor(), path, Source())


def test_a_folder_that_is_called_as_an_archive_stays_one(tmp_path: Path, say: Say) -> None:
    (tmp_path / "lab/day1.zip").mkdir(parents=True)
    for k in (1, 2):
        (tmp_path / f"lab/day1.zip/heat{k}.csv").write_text(log(k))
    assert {test for test, *_ in rows_of(tmp_path / "lab", say)} == {"heat1", "heat2"}


def test_a_table_of_tests_in_the_archive_tells_their_conditions(tmp_path: Path, say: Say) -> None:
    heads = {f"S{n}_{k}.csv": log(k).replace("3000", str(n)) for k, n in enumerate((3000, 6000, 9000), 1)}
    listed = "test;coolant\n" + "".join(f"{name[:-4]};{'on' if '6' in name else 'off'}\n" for name in heads)
    zipped(tmp_path / "lab/day.zip", {**heads, "tests.csv": listed})
    rows_of(tmp_path / "lab", say)
    with Store(tmp_path / "lab.store").reader() as con:
        found = dict(con.execute("select test, conditions->>'coolant' from test").fetchall())
    assert found == {"S3000_1": "off", "S6000_2": "on", "S9000_3": "off"}


def test_names_of_one_pattern_in_an_archive_become_tests_from(tmp_path: Path, say: Say) -> None:
    names = {f"S{n}_F{100 * k}_{k}.csv": log(k).replace("3000", str(n)) for k, n in enumerate((3000, 6000, 9000), 1)}
    for name, text in names.items():
        written(tmp_path / "loose/day" / name, text.encode())
    zipped(tmp_path / "zip/day.zip", dict(names))
    assert rows_of(tmp_path / "zip", say) == rows_of(tmp_path / "loose", say)
    assert 'files: "day.zip/S{speed}_F{feed}_{nr}.csv"' in (tmp_path / "zip/campaign.yaml").read_text()


def test_an_archive_of_an_office_file_and_one_of_nothing_are_no_logs(tmp_path: Path) -> None:
    (tmp_path / "heat1.csv").write_text(log(1))
    zipped(tmp_path / "report.docx", {"[Content_Types].xml": "<Types/>", "word/document.xml": "<w/>"})
    zipped(tmp_path / "empty.zip", {})
    draft = draft_files(tmp_path).draft
    assert [t.id for t in draft.tests] == ["heat1"]
    assert {p for p, _ in draft.not_used} == {"report.docx", "empty.zip"}


@pytest.mark.parametrize(("pack", "end"), [(gzip.compress, "gz"), (bz2.compress, "bz2"), (lzma.compress, "xz")])
def test_a_packed_log_that_is_cut_off_is_read_to_its_cut_as_one_that_is_not_packed(
    tmp_path: Path, say: Say, pack: Callable[[bytes], bytes], end: str
) -> None:
    lab = tmp_path / "lab"
    lab.mkdir()
    rows = [f"2026-03-01T08:00:00.{i:06d}Z,{hashlib.md5(bytes([i % 251])).hexdigest()}{i}" for i in range(60_000)]
    whole = ("time,serial\n" + "\n".join(rows) + "\n").encode()
    packed = pack(whole)
    (lab / f"heat1.csv.{end}").write_bytes(packed[: len(packed) * 9 // 10])
    (lab / f"heat2.csv.{end}").write_bytes(packed)
    assert say("init", lab).code == 0
    text = (lab / "campaign.yaml").read_text()
    assert f"# damaged: heat1.csv.{end}: the packed file is cut off: what stands before the cut is read" in text
    assert "heat2.csv" not in text.split("# damaged", 1)[1]
    store = Store(tmp_path / "store", create=True)
    summary = ingest(store, lab / "campaign.yaml")
    told = [loss for loss in summary.losses if "the packed file is cut off" in str(loss)]
    assert len(told) == 1
    assert f"the end of heat1.csv.{end}" in str(told)
    with store.reader() as con:
        found = dict(con.execute("select source_path, rows from file where layer = 'raw'").fetchall())
    assert found[f"heat2.csv.{end}"] == 60_000
    assert 30_000 < found[f"heat1.csv.{end}"] < 60_000


@pytest.mark.parametrize("within", [True, False])
def test_an_archive_without_an_end_mark_is_read_to_its_cut(tmp_path: Path, say: Say, within: bool) -> None:
    """As of a logger that was switched off."""
    data = b"".join(entry(f"heat{k}.csv") for k in range(3))
    lab = written(tmp_path / "lab/day.tar", data[: -700 if within else len(data)]).parent
    assert say("init", lab).code == 0
    text = (lab / "campaign.yaml").read_text()
    if within:
        assert "# damaged: day.tar/heat2.csv: the archive ends within this file: what stands before" in text
        assert "# damaged: day.tar: the archive ends within 'heat2.csv': the rest of it, and what stood" in text
    else:
        assert "# damaged: day.tar: the archive has no end mark behind 'heat2.csv': if more stood there" in text
    store = Store(tmp_path / "store", create=True)
    summary = ingest(store, lab / "campaign.yaml")
    assert summary.files == 3
    told = {loss["file"]: loss["reason"] for loss in summary.losses}
    assert told.keys() == ({"day.tar/heat2.csv", "day.tar"} if within else {"day.tar"})
    assert ("ends within 'heat2.csv'" if within else "no end mark") in told["day.tar"]
    written(lab / "day.tar", data + bytes(1024))
    assert ingest(store, lab / "campaign.yaml").losses == []
