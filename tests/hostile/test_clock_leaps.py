"""Clocks without a battery: rows of the boot clock, years before the others, in files of several tests."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
import yaml

from .conftest import Lab
from .test_mcap import LOG, X, recording

S = 1_000_000_000
T0 = 1_772_438_400 * S  # 2026-03-02 08:00 UTC
DAY = 86_400 * S


def _booted(begin: int, rows: int, boot: int) -> np.ndarray:
    """Times every 10 s, the first of which count from the boot."""
    t = begin + 10 * S * np.arange(rows, dtype=np.int64)
    t[:boot] -= begin - 17 * S
    return t


def _csv(t_ns: Iterable[int]) -> str:
    rows = [f"{np.datetime64(int(t) // S, 's')}Z,{20 + k / 50:.3f}" for k, t in enumerate(t_ns)]
    return "\n".join(["time,T_bed [degC]", *rows, ""])


def _drafted_tests(lab: Lab) -> list[str]:
    assert lab.say("init", lab.folder).code == 0
    draft = yaml.safe_load((lab.folder / "campaign.yaml").read_text(encoding="utf-8"))
    return [t["id"] for t in draft["tests"]]


def _write(lab: Lab, suffix: str, name: str, t_ns: np.ndarray) -> None:
    x = recording((int(t), {"x": 20 + k / 50}) for k, t in enumerate(t_ns))
    lab.write(f"{name}.{suffix}", x if suffix == "mcap" else _csv(t_ns))


@pytest.mark.parametrize("suffix", ["csv", "mcap"])
def test_a_head_of_the_boot_clock_makes_no_file_a_part_of_the_one_before(lab: Lab, suffix: str) -> None:
    _write(lab, suffix, "rec_0", _booted(T0, 400, 0))
    _write(lab, suffix, "rec_1", _booted(T0 + DAY, 400, 40))
    assert _drafted_tests(lab) == ["rec_0", "rec_1"]


@pytest.mark.parametrize("suffix", ["csv", "mcap"])
@pytest.mark.parametrize("boot", [0, 40])
def test_parts_that_go_on_are_one_test_with_or_without_such_a_head(lab: Lab, suffix: str, boot: int) -> None:
    _write(lab, suffix, "rec_0", _booted(T0, 400, boot))
    _write(lab, suffix, "rec_1", _booted(T0 + 4000 * S, 400, 0))
    assert _drafted_tests(lab) == ["rec"]


def test_messages_of_the_boot_clock_are_moved_up_and_told(lab: Lab) -> None:
    t = _booted(T0, 400, 40)
    t[100:110] = t[100:110][::-1]
    lab.write("raw/a.mcap", recording((int(t_ns), {"x": k}) for k, t_ns in enumerate(t)))
    said = lab.ingest(X, LOG)
    assert said.code == 0
    assert "the clock was set ahead by 56.2 years" in said.out
    assert "out of order: sorted" in said.out
    t_s, values = lab.values("pos")
    np.testing.assert_allclose(t_s, 10 * np.arange(400), atol=1)
    assert values.tolist() == [*range(100), *range(109, 99, -1), *range(110, 400)]
    first = json.loads(lab("sql", "select min(t)::varchar as t from sample", "--json").out)
    assert first[0]["t"].startswith("2026-03-02 08:00:00")


def test_files_of_two_days_that_are_declared_as_one_test_are_not_sorted_into_each_other(lab: Lab) -> None:
    for name, t in (("a", _booted(T0, 400, 0)), ("b", _booted(T0 + DAY, 400, 40))):
        lab.write(f"raw/{name}.mcap", recording((int(t_ns), {"x": k}) for k, t_ns in enumerate(t)))
    said = lab.ingest(X, LOG)
    assert said.code == 3
    assert "clock goes backwards" in said.out
    t_s, _ = lab.values("pos")
    assert t_s.max() < 2 * 86_400


def test_a_preview_tells_a_leap_and_no_pause(lab: Lab) -> None:
    leap = lab.write("leap.csv", _csv(_booted(T0, 400, 40)))
    t = _booted(T0, 400, 0)
    t[200:] += 90 * DAY
    pause = lab.write("pause.csv", _csv(t))

    def notes(path: Path) -> str:
        return " ".join(json.loads(lab.say("preview", path, "--json").out)["notes"])

    assert "leaps ahead by 56.2 years at row 41" in notes(leap)
    assert "leaps" not in notes(pause)
