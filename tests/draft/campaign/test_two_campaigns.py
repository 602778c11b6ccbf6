"""Logs of two machines in one folder are asked about, with how each is drafted; one machine's are not."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say

_ONE = ["dZ [um]", "T_front [degC]", "T_hall [degC]", "speed [rpm]"]
_OTHER = ["Z1 [um]", "Lager vorn [degC]", "Luft [degC]", "Drehzahl [1/min]"]


def _log(path: Path, names: Sequence[str], head: str = "") -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    t = np.arange(0, 3600, 10.0)
    rows = [f"{x:.0f}," + ",".join(f"{20 + k + 5 * x / (x + 900):.3f}" for k in range(len(names))) for x in t]
    path.write_text("\n".join([f"{head}t [s],{','.join(names)}", *rows, ""]), encoding="utf-8")


def _said(folder: Path, say: Say) -> tuple[str, str]:
    """(the line of the machine, all of the draft)."""
    said = say("init", folder)
    assert said.code == 0
    text = (folder / "campaign.yaml").read_text(encoding="utf-8")
    line = next(x for x in text.splitlines() if x.startswith("  id: unknown"))
    assert ("campaigns, of 2 machines?" in said.err) is ("campaigns, of 2 machines?" in line)
    return line, text


@pytest.mark.parametrize(
    ("of_one", "of_other", "how"),
    [
        ("mill/W", "lathe/R", "from within this folder: thermodata init lathe and thermodata init mill"),
        ("mill_W", "lathe_R", "a folder of its own, and draft each: thermodata init SUBFOLDER"),
    ],
)
def test_tests_without_a_common_column_that_are_called_apart(
    tmp_path: Path, say: Say, of_one: str, of_other: str, how: str
) -> None:
    for k in range(3):
        _log(tmp_path / f"{of_one}{k}.csv", _ONE)
        _log(tmp_path / f"{of_other}{k}.csv", _OTHER)
    line, _ = _said(tmp_path, say)
    assert "# ? 2 campaigns, of 2 machines? the tests of 'lathe' (" in line
    assert "have no column in common" in line
    assert how in line


def test_machines_that_the_heads_name_are_asked_and_their_columns_are_not_joined(tmp_path: Path, say: Say) -> None:
    for k in range(3):
        _log(tmp_path / f"W{k}.csv", _ONE, "# Machine: DMU 80\n")
        _log(tmp_path / f"R{k}.csv", _OTHER, "# Maschine: CTX beta\n")
    line, text = _said(tmp_path, say)
    assert "the heads of the logs name 'CTX beta' (R0, R1, R2) and 'DMU 80' (W0, W1, W2)" in line
    assert "under two names?" not in text


def test_one_machine_that_the_heads_name_is_proposed(tmp_path: Path, say: Say) -> None:
    for k in range(3):
        _log(tmp_path / f"mill/W{k}.csv", _ONE, "# Machine: DMU 80\n")
        _log(tmp_path / f"lathe/R{k}.csv", _OTHER, "# Machine: dmu 80\n")
    line, text = _said(tmp_path, say)
    assert line.endswith("# ? the machine's number: 'DMU 80', as logs call it?") or "'dmu 80'" in line
    assert "under two names?" in text  # one machine's columns may be called otherwise


@pytest.mark.parametrize(
    ("of_one", "of_other", "names"),
    [
        ("W", "R", _OTHER),  # nothing but a number's letter tells them apart: renamed columns
        ("mill/W", "lathe/R", [*_OTHER, "T_hall [degC]"]),  # a column in common
        ("a/W", "b/W", _OTHER),  # two loggers of the same tests
    ],
)
def test_what_may_be_one_machine(tmp_path: Path, say: Say, of_one: str, of_other: str, names: Sequence[str]) -> None:
    stem = "P" if of_one == "W" else ""
    for k in range(3):
        _log(tmp_path / (f"{stem}{k}.csv" if stem else f"{of_one}{k}.csv"), _ONE)
        _log(tmp_path / (f"{stem}{k + 3}.csv" if stem else f"{of_other}{k}.csv"), names)
    line, _ = _said(tmp_path, say)
    assert "campaigns" not in line
