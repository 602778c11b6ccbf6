"""A folder that may only be read: what, where, and what to do."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow.csv
import pyarrow.parquet
import pytest

from thermodata.cli.terminal.common import known_failure

from ..commands import Said


@pytest.fixture
def refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Who may write anywhere, as tests may, is refused by Arrow as others are."""

    def refuse(table: Any, path: Any, *more: Any, **named: Any) -> None:
        text = f"Failed to open local file '{path}'. Detail: [errno 13] Permission denied"
        raise PermissionError(errno.EACCES, text)

    monkeypatch.setattr(pyarrow.parquet, "write_table", refuse)
    monkeypatch.setattr(pyarrow.csv, "write_csv", refuse)


def test_a_store_that_may_only_be_read_takes_no_fit(say: Callable[..., Said], campaign: Path, refused: None) -> None:
    said = say("--store", campaign / "thermodata.store", "fit", campaign / "baseline.yaml")
    assert said.code == 4
    assert "the store can only be read" in said.err
    assert "where: " in said.err
    assert "try: give yourself the right" in said.err


def test_a_folder_that_may_only_be_read_takes_no_export(
    say: Callable[..., Said], campaign: Path, tmp_path: Path, refused: None
) -> None:
    said = say("--store", campaign / "thermodata.store", "export", "small", "day1", tmp_path / "out.csv")
    assert said.code == 1
    assert f"where: {tmp_path}{os.sep}" in said.err
    assert "try: name a folder of your own" in said.err


@pytest.mark.parametrize("code", [errno.EACCES, errno.EPERM, errno.EROFS])
def test_what_names_no_file_is_no_matter_of_folders(code: int) -> None:
    """A process that may not be signalled, a socket that may not be opened."""
    assert known_failure(OSError(code, os.strerror(code))) is None
    for named in (OSError(code, os.strerror(code), "a.csv"), OSError(code, "Failed to open local file 'a.csv'.")):
        said = known_failure(named)
        assert said is not None
        assert said.where == "a.csv"
        assert "a folder of your own" in (said.hint or "")
