"""What the benchmark of machines that others made counts: a command that fails ends it, and is no result."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"
HIDDEN = [{"cause": "nut", "right": ["feed_screw:T_nut_Z"], "twins": []}]


@pytest.fixture
def outside(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(BENCHMARKS)
    return import_module("outside")


def lab(outside: Any, folder: Path, code: int) -> Any:
    program = folder / "program"
    program.write_text(
        f'#!/bin/sh\necho \'{{"locked_rmse_um_before": 4.0, "locked_rmse_um_after": 3.0}}\'\nexit {code}\n'
    )
    program.chmod(0o755)
    return outside.Lab(folder, str(program))


@pytest.mark.parametrize(("code", "worth"), [(0, 0.25), (2, None)])
def test_a_name_is_worth_what_it_takes_off_and_nothing_known_where_it_is_refused(
    outside: Any, tmp_path: Path, code: int, worth: float | None
) -> None:
    assert outside.worth(lab(outside, tmp_path, code), "model", HIDDEN) == worth


@pytest.mark.parametrize("code", [1, 4, 139])
def test_a_command_that_fails_is_told(outside: Any, tmp_path: Path, code: int) -> None:
    with pytest.raises(RuntimeError, match=f"confirm .*: exit code {code}"):
        outside.worth(lab(outside, tmp_path, code), "model", HIDDEN)


@pytest.mark.parametrize(
    ("worth", "sort"),
    [
        (0.3, "one, worth 30 %"),
        (0.1, "one, worth 10 to 30 %"),
        (0.0, "one, worth less"),
        (-1.0, "one, worth less"),
        (None, "one, worth not known"),
    ],
)
def test_each_case_of_one_cause_stands_in_one_row(outside: Any, worth: float | None, sort: str) -> None:
    assert [name for name, counts in outside.SORTS.items() if counts({"kind": "one", "worth": worth})] == [sort]


def test_all_claims_are_added_at_once_and_the_locked_error_is_that_with_all(outside: Any, tmp_path: Path) -> None:
    program = tmp_path / "program"
    answer = '{"model": "b", "locked_rmse_um_before": 4.0, "locked_rmse_um_after": 1.0}'
    program.write_text(f"#!/bin/sh\necho $* > {tmp_path}/asked\necho '{answer}'\n")
    program.chmod(0o755)
    assert outside.with_all(outside.Lab(tmp_path, str(program)), "a", ["one", "two"]) == ("b", 4.0, 1.0)
    assert (tmp_path / "asked").read_text().startswith("add a one two ")
