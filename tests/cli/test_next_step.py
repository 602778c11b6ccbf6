"""What an ingest says to do next."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from .conftest import Said, write_campaign

Say = Callable[..., Said]


def test_after_nothing_was_read_no_model_is_proposed(say: Say, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    whole = {log: log.read_bytes() for log in (tmp_path / "lab/raw").iterdir()}
    for log in whole:
        log.write_bytes(b"\x00\x01\x02" * 50)
    done = say("--store", tmp_path / "s", "ingest", path)
    assert done.code == 3
    assert done.err.splitlines()[-1] == f"next: mend what was lost, then thermodata ingest {path} again"
    for log, content in list(whole.items())[:1]:
        log.write_bytes(content)
    done = say("--store", tmp_path / "s", "ingest", path)
    assert done.code == 3, "but there is a test to fit"
    assert "next: thermodata first-model" in done.err.splitlines()[-1]
