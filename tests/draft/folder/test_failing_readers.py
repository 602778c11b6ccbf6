"""Readers that fail at a file of a folder: it is named with the reader and its error, and the others are drafted."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Recording, Signal, Source
from thermodata.reader.finding import registry
from thermodata.schema.files.load import load_campaign


class _Breaking:
    """Claims files that end in .brk, and stumbles over them as its letter says."""

    name = "breaking"
    block_rows = None

    def sniff(self, head: Head) -> str | None:
        return "ends in .brk" if head.name.endswith(".brk") else None

    def describe(self, path: Path, source: Source) -> Recording:
        letter = path.read_text()
        if letter == "bug":
            raise KeyError("gain")
        if letter == "cut":
            raise FormatError("the header is cut", where=path.name, got="12 bytes")
        if letter == "room":
            raise MemoryError
        return Recording((Signal("T_front [degC]", "s", "degC", "float64"),), "relative", None, True)

    def blocks(self, path: Path, source: Source) -> Iterator[Block]:
        yield Block("s", np.arange(50) * 1_000_000_000, {"T_front [degC]": np.linspace(20.0, 30.0, 50)})
        if path.read_text() == "late":
            raise ZeroDivisionError("no gain")


@pytest.fixture
def breaking(monkeypatch: pytest.MonkeyPatch) -> None:
    everybody = registry.readers()
    monkeypatch.setattr(registry, "_readers_and_failures", lambda: ({**everybody, "breaking": _Breaking()}, {}))


@pytest.mark.usefixtures("breaking")
@pytest.mark.parametrize(
    ("letter", "said_of_it"),
    [
        ("bug", "reader 'breaking' failed to describe a file (KeyError: 'gain')"),
        ("cut", "the header is cut (12 bytes)"),
        ("room", "MemoryError"),
    ],
)
@pytest.mark.parametrize("beside", [False, True])
def test_a_reader_that_fails_is_named_with_its_error_and_the_file(
    tmp_path: Path, say: Say, letter: str, said_of_it: str, beside: bool
) -> None:
    (tmp_path / "day1.brk").write_text(letter)
    if beside:
        (tmp_path / "day2.brk").write_text("good")
    said = say("init", tmp_path)
    assert said.code == 0
    assert f"day1.brk: reader 'breaking' claims it and can't read it: {said_of_it}" in said.err
    assert "no reader claims any file" not in said.err
    assert ("no file of" in said.err) is not beside
    text = (tmp_path / "campaign.yaml").read_text()
    load_campaign(tmp_path / "campaign.yaml")
    assert f"# not used: day1.brk: reader 'breaking' claims it and can't read it: {said_of_it}" in text
    if beside:
        assert "{reader: breaking, files: " in text
    else:
        assert "what stopped its reader" in text
        assert '# log: {reader: breaking, files: "{test}.brk"}   # ? what is wrong with day1.brk?' in text
    answer = json.loads(say("init", tmp_path, "--force", "--json").out)
    assert answer["failed"] == [{"file": "day1.brk", "reader": "breaking"}]


@pytest.mark.usefixtures("breaking")
def test_a_reader_that_fails_within_a_file_is_named_with_its_error(tmp_path: Path, say: Say) -> None:
    (tmp_path / "day1.brk").write_text("late")
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text()
    assert "# damaged: day1.brk: reader 'breaking' stopped in it: reader 'breaking' failed (ZeroDivision" in text
    assert "T_front" in text, "what was read before is drafted"


@pytest.mark.usefixtures("breaking")
def test_files_at_which_readers_fail_are_in_the_folders_order(tmp_path: Path, say: Say) -> None:
    for name in ("b10", "a1", "b2"):
        (tmp_path / f"{name}.brk").write_text("bug")
    answer = json.loads(say("init", tmp_path, "--json").out)
    assert [f["file"] for f in answer["failed"]] == ["a1.brk", "b2.brk", "b10.brk"]


def test_a_list_of_tests_that_a_reader_claims_is_no_failure(tmp_path: Path, say: Say) -> None:
    for test in ("day1", "day2"):
        rows = "".join(f"{i},{20 + 0.1 * i}\n" for i in range(50))
        (tmp_path / f"{test}.csv").write_text(f"time [s],T_front [degC]\n{rows}")
    (tmp_path / "tests.csv").write_text("test,speed [rpm],air [degC]\nday1,3000,21.5\nday2,6000,22.0\n")
    said = say("init", tmp_path)
    assert said.code == 0
    assert "can't read" not in said.err
    text = (tmp_path / "campaign.yaml").read_text()
    assert "tests.csv" in text
    assert "not used: tests.csv" not in text
