"""MAT: names and units that stand in variables of their own belong to the variable that they are called after."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from thermodata_reader_table import Reader

from thermodata.plugin import Recording, Source

N = 60
TIME = np.arange(N, dtype=float)[:, None]
A = 20 + np.cumsum(np.ones((N, 3)), 0) / 100
B = 5 - A


def words(*said: str) -> Any:
    made = np.empty((len(said), 1), object)
    made[:, 0] = said
    return made


PLACES, AXES = words("front", "rear", "hall"), words("X", "Y", "Z")


def described(tmp_path: Path, **variables: Any) -> Recording:
    path = tmp_path / "x.mat"
    scipy.io.savemat(path, {"t": TIME, **variables})
    return Reader().describe(path, Source())


def said(tmp_path: Path, **variables: Any) -> list[tuple[str, str | None]]:
    return [(s.name, s.unit) for s in described(tmp_path, **variables).signals]


@pytest.mark.parametrize(
    ("of_t", "of_e"),
    [
        ("T_names", "E_names"),
        ("T_label", "E_label"),
        ("names_T", "names_E"),
        ("Tnames", "Enames"),
        ("T_Header", "E_Header"),
    ],
)
def test_each_matrix_has_its_own_names(tmp_path: Path, of_t: str, of_e: str) -> None:
    found = said(tmp_path, T=A, E=B, **{of_t: PLACES, of_e: AXES})
    assert [name for name, _ in found] == ["T/front", "T/rear", "T/hall", "E/X", "E/Y", "E/Z"]


def test_names_of_another_matrix_are_never_taken(tmp_path: Path) -> None:
    found = said(tmp_path, T=A, E=B, T_names=PLACES)
    assert [name for name, _ in found] == ["T/front", "T/rear", "T/hall", "E(:,1)", "E(:,2)", "E(:,3)"]


def test_names_of_none_are_those_of_all(tmp_path: Path) -> None:
    found = said(tmp_path, raw=A, calibrated=B, names=PLACES)
    assert [name for name, _ in found][::3] == ["raw/front", "calibrated/front"]


def test_a_list_called_after_no_variable_is_that_of_the_one_matrix_as_wide(tmp_path: Path) -> None:
    alone = said(tmp_path, T=A, E=B[:, :2], placeNames=PLACES)
    assert [name for name, _ in alone] == ["T/front", "T/rear", "T/hall", "E(:,1)", "E(:,2)"]
    both = described(tmp_path, T=A, E=B, placeNames=PLACES)
    assert both.signals[0].name == "T(:,1)"
    assert "'placeNames' may be of T or E: not used; call it T_names, say" in both.notes


def test_a_list_is_of_the_variable_that_differs_by_case_where_one_does(tmp_path: Path) -> None:
    found = said(tmp_path, Temp=A, Disp=B, tempNames=PLACES)
    assert [name for name, _ in found][::3] == ["Temp/front", "Disp(:,1)"]


def test_names_beside_a_struct_are_those_of_the_matrix_within(tmp_path: Path) -> None:
    found = said(tmp_path, run={"t": TIME, "data": A, "power": TIME}, run_names=PLACES, other_names=AXES)
    assert [name for name, _ in found] == ["run/power", "front", "rear", "hall"]


def test_one_unit_is_that_of_all_columns_of_its_matrix(tmp_path: Path) -> None:
    found = said(tmp_path, T=A, T_unit="degC", E=B, E_units=words("um", "mm", "V"))
    assert [unit for _, unit in found] == ["degC"] * 3 + ["um", "mm", "V"]


@pytest.mark.parametrize(
    ("variables", "note"),
    [
        ({"T": A, "T_unit": "degC"}, True),
        ({"T": A, "T_unit": "min"}, True),  # a temperature in minutes is asked of it, not of the time
        ({"T": A, "T_unit": "degC", "t_unit": "min"}, False),
        ({"X": TIME, "X_unit": "um", "time_unit": "min"}, False),
        ({"X": TIME, "X_unit": "um", "T_unit": "min"}, False),
        ({"X": TIME, "X_unit": "um", "T_unit": "degC"}, True),
    ],
)
def test_a_unit_of_a_large_t_is_none_of_the_time(tmp_path: Path, variables: dict[str, Any], note: bool) -> None:
    found = described(tmp_path, **variables)
    assert found.signals[0].unit == variables.get("X_unit", variables.get("T_unit"))
    assert not [n for n in found.notes if "is none of time" in n]
    assert bool([n for n in found.notes if "taken as seconds" in n]) is note


def test_the_unit_of_the_time_is_taken_whatever_its_spelling(tmp_path: Path) -> None:
    for name in ("t_unit", "tUnit", "time_unit", "timeUnit"):
        path = tmp_path / "x.mat"
        scipy.io.savemat(path, {"t": TIME, "T": A, name: "min"})
        blocks = list(Reader().blocks(path, Source()))
        assert blocks[0].t_ns[-1] == (N - 1) * 60_000_000_000  # type: ignore[union-attr]


def test_a_unit_of_a_large_t_without_a_variable_t_is_that_of_the_time_where_it_is_one_of_time(tmp_path: Path) -> None:
    for unit, step_s in (("min", 60), ("Min ", 60), ("degC", 1)):
        path = tmp_path / "x.mat"
        scipy.io.savemat(path, {"t": TIME, "X": A, "T_unit": unit})
        blocks = list(Reader().blocks(path, Source()))
        assert blocks[0].t_ns[-1] == (N - 1) * step_s * 1_000_000_000  # type: ignore[union-attr]
