"""What an ingest says to do next."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

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


def test_without_roles_there_is_nothing_to_fit(say: Say, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    path.write_text(re.sub("role: [a-z]+", "role: none", path.read_text()))
    model = path.with_name("model.yaml")

    def step() -> str:
        done = say("--store", tmp_path / "s", "ingest", path)
        assert done.code == 0
        return str(done.err.splitlines()[-1])

    said = step()
    assert said.startswith(f"next: give the tests roles in {path}, for none has 'role: calibration'")
    assert said.endswith(f"thermodata first-model {path} drafts {model}; thermodata fit {model}")
    baseline = path.with_name("baseline.yaml").read_text()
    model.write_text(baseline)
    assert "give the tests roles" in step()
    model.write_text(baseline + "calibrate_on: [heat1]\n")
    assert step() == f"next: thermodata fit {model}"
    assert say("--store", tmp_path / "s", "fit", model).code == 0


@pytest.mark.parametrize(("signal", "read"), [("dZ", True), ("T_bearing", True), ("T_nut_Z", False)])
def test_a_channel_that_every_test_lost_is_mended_first_where_the_model_reads_it(
    say: Say, tmp_path: Path, signal: str, read: bool
) -> None:
    path = write_campaign(tmp_path / "lab")
    logs = sorted((tmp_path / "lab/raw").iterdir())
    whole = logs[0].read_text()
    for log in logs:
        log.write_text(log.read_text().replace(f"{signal} [", "other ["))

    def step() -> str:
        done = say("--store", tmp_path / "s", "ingest", path)
        assert done.code == 3
        return str(done.err.splitlines()[-1])

    model = path.with_name("model.yaml")
    again = f"then thermodata ingest {path} again"
    assert step() == f"next: mend {signal}, which a first model may read and every test lost, {again}"
    model.write_text(path.with_name("baseline.yaml").read_text())
    mend = f"next: mend {signal}, which {model} reads and every test lost, {again}"
    assert step() == (mend if read else f"next: thermodata fit {model}")
    logs[0].write_text(whole)  # one test has it
    assert step() == f"next: thermodata fit {model}"
