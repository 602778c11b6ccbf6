"""Archives of many files: each file is looked at once, however many are called as it is."""

from __future__ import annotations

import zipfile
from collections import Counter
from contextlib import AbstractContextManager
from pathlib import Path, PurePosixPath
from unittest.mock import Mock

import pytest

from thermodata.draft.folder.put_aside import packed_copies as module
from thermodata.draft.folder.put_aside.packed_copies import by_archive, packed_copies


def test_logs_of_one_name_and_one_length_are_each_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    texts = [f"time [s],x\n{k:06d},1\n" for k in range(8)]
    with zipfile.ZipFile(tmp_path / "all.zip", "w") as zipped:
        for k, text in enumerate(texts):
            zipped.writestr(f"t{k}/log.csv", text if k % 2 else text.upper())
    for k, text in enumerate(texts):
        (tmp_path / f"u{k}").mkdir()
        (tmp_path / f"u{k}/log.csv").write_text(text)
    paths = [PurePosixPath(f"{of}{k}/log.csv") for k in range(8) for of in ("all.zip/t", "u")]
    read: Counter[Path] = Counter()

    def counted(path: Path) -> AbstractContextManager[Path]:
        read[path] += 1
        return held(path)

    held = module.held
    monkeypatch.setattr(module, "held", counted)
    assert packed_copies(tmp_path, paths) == {
        PurePosixPath(f"all.zip/t{k}/log.csv"): PurePosixPath(f"u{k}/log.csv") for k in range(1, 8, 2)
    }
    assert set(read.values()) == {1}


def test_an_archive_is_held_only_against_those_that_share_a_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    paths = [PurePosixPath(f"day{k}.zip/T{k}_{i}.csv") for k in range(20) for i in range(5)]
    for k in range(20):
        with zipfile.ZipFile(tmp_path / f"day{k}.zip", "w") as zipped:
            for path in paths[5 * k : 5 * k + 5]:
                zipped.writestr(path.name, "time [s],x\n0,1\n")
    named: Counter[PurePosixPath] = Counter()

    def counted(path: PurePosixPath) -> PurePosixPath:
        named[path] += 1
        return as_unpacked(path)

    as_unpacked = module.as_unpacked
    monkeypatch.setattr(module, "as_unpacked", counted)
    held = Mock(side_effect=module._ByLogName.all_like, autospec=True)
    monkeypatch.setattr(module._ByLogName, "all_like", held)
    assert packed_copies(tmp_path, paths) == {}
    assert set(named.values()) == {1}
    assert not held.called


def copies_in(folder: Path, archives: dict[str, dict[str, str]]) -> dict[str, str]:
    for archive, files in archives.items():
        with zipfile.ZipFile(folder / archive, "w") as zipped:
            for name, text in files.items():
                zipped.writestr(name, text)
    paths = [PurePosixPath(f"{archive}/{name}") for archive, files in archives.items() for name in files]
    return {str(p): str(of) for p, of in packed_copies(folder, paths).items()}


@pytest.mark.parametrize(
    "told",
    [["T{k}/S1.csv"], ["axis1.csv"], ["axis1.csv", "axis2.csv"], ["S/S1.csv"]],
)
def test_a_numbered_log_that_archives_of_other_tests_share_is_one_of_each(tmp_path: Path, told: list[str]) -> None:
    of_days = {
        f"day{k}.zip": {f"T{k}/T{k}_disp.csv": f"time [s],x\n0,{k}\n"}
        | {name.format(k=k): "time [s],n\n0,3000\n" for name in told}
        for k in (1, 2)
    }
    assert copies_in(tmp_path, of_days) == {}


def test_folders_of_tests_that_two_archives_share_are_copies(tmp_path: Path) -> None:
    def files(*tests: int) -> dict[str, str]:
        return {f"T{k}/{name}.csv": f"time [s],{name}\n0,{k}\n" for k in tests for name in ("d", "S1")}

    assert copies_in(tmp_path, {"week.zip": files(1, 2, 3), "b.zip": files(2, 9) | {"T9/e.csv": "x"}}) == {
        f"b.zip/T2/{name}.csv": f"week.zip/T2/{name}.csv" for name in ("d", "S1")
    }


def test_a_log_that_is_gone_by_now_is_no_copy(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "all.zip", "w") as zipped:
        zipped.writestr("log.csv", "time [s],x\n0,1\n")
    (tmp_path / "log.csv").write_text("time [s],x\n0,1\n")
    paths = [PurePosixPath(name) for name in ("all.zip/log.csv", "u1/log.csv", "log.csv")]
    assert packed_copies(tmp_path, paths) == {paths[0]: paths[2]}


def test_an_archive_of_photos_is_worded_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = [f"p{k:02d}.jpg" for k in range(40)]
    with zipfile.ZipFile(tmp_path / "photos.zip", "w") as zipped:
        for name in names:
            zipped.writestr(name, "x")
    worded = []

    def counted(items: list[str], shown: int) -> str:
        worded.append(items)
        return with_count(items, shown)

    with_count = module.with_count
    monkeypatch.setattr(module, "with_count", counted)
    ((path, why),) = by_archive(tmp_path, [(f"photos.zip/{name}", "no table") for name in names], [], [])
    assert (path, why) == (
        "photos.zip",
        "no file in it is read as a log (p00.jpg, p01.jpg, p02.jpg and 37 more): no table",
    )
    assert len(worded) == 1
