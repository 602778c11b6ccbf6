"""Where a file that is taken away can't be written, the error says which, and what room there is."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from tests.no_room import no_file_longer_than
from thermodata.cli.terminal.common import known_failure
from thermodata.errors import ThermodataError
from thermodata.export import export_test
from thermodata.report.page.write import write_page
from thermodata.store.base.files import not_written, whole_file, write_error
from thermodata.view import StoreView

from .test_take_away import view as view  # a store with one test


@pytest.mark.parametrize("name", ["out.csv", "out.parquet", "out.mat", "out.mf4"])
def test_an_export_to_a_full_disk_says_where(view: StoreView, tmp_path: Path, name: str) -> None:
    out = tmp_path / "away" / name
    with no_file_longer_than(200), pytest.raises(ThermodataError, match="longer than it may be") as error:
        export_test(view, "c", "sp9000", out, step="1 s")
    assert error.value.where == str(out)
    assert "ulimit -f" in str(error.value.hint)
    assert error.value.exit_code == 4, "as every full disk"
    assert list(out.parent.iterdir()) == []
    export_test(view, "c", "sp9000", out, step="1 s")
    assert [p.name for p in out.parent.iterdir()] == [name]


def test_a_page_on_a_full_disk_says_where_and_the_old_page_stays(tmp_path: Path) -> None:
    page = write_page(tmp_path / "r.html", "old")
    with no_file_longer_than(200), pytest.raises(ThermodataError, match="longer than it may be") as error:
        write_page(page, "new" * 1000)
    assert error.value.where == str(page)
    assert page.read_text() == "old"


def test_without_a_right_it_is_not_called_full(tmp_path: Path) -> None:
    with pytest.raises(ThermodataError, match="no right to write there") as error, whole_file(tmp_path / "a") as part:
        raise OSError(errno.EACCES, "Permission denied", str(part))
    assert error.value.where == str(tmp_path / "a")
    assert "Permission denied" in str(error.value.got)


def test_a_folder_that_is_a_file_is_said(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("")
    with pytest.raises(ThermodataError, match="cannot be written") as error, whole_file(tmp_path / "a" / "b.csv"):
        raise AssertionError("nothing can be written there")
    assert error.value.where == str(tmp_path / "a" / "b.csv")


def test_a_file_is_on_the_disk_before_it_has_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A power cut after the renaming would else leave an empty file."""
    target, there = tmp_path / "a.csv", []
    sync = os.fsync
    monkeypatch.setattr(os, "fsync", lambda fd: (there.append(target.exists()), sync(fd)))
    with whole_file(target) as part:
        part.write_text("x")
    assert there[0] is False
    assert target.read_text() == "x"


@pytest.mark.parametrize(
    ("code", "what", "tells_free"),
    [
        (errno.ENOSPC, "the disk is full", True),
        (errno.EDQUOT, "the quota of the disk is used up", False),
        (errno.EFBIG, "the file is longer than it may be", False),
    ],
)
def test_each_way_to_have_no_room_is_said_as_what_it_is(tmp_path: Path, code: int, what: str, tells_free: bool) -> None:
    """What is free on the disk is told only where that is what lacks."""
    error = OSError(code, os.strerror(code))
    for said in (write_error(tmp_path / "a", error), not_written(tmp_path / "a", error), known_failure(error)):
        assert said is not None
        assert (said.what, said.exit_code) == (what, 4)
    assert ("MB free" in str(write_error(tmp_path / "a", error))) is tells_free
