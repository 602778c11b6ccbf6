"""Arrays whose elements have names: in an array beside them, or in a field of each element."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

T0, MINUTE = 1_772_434_800_000_000_000, 60 * 10**9
FRONT, REAR = [20 + k / 8 for k in range(60)], [30 - k / 8 for k in range(60)]


def _pairs(k: int, swapped: bool) -> list[tuple[str, float]]:
    pairs = [("T_front", FRONT[k]), ("T_rear", REAR[k])]
    return pairs[::-1] if swapped else pairs


@pytest.mark.parametrize("swap_at", [0, 45, 100])
@pytest.mark.parametrize("key", ["name", "names", "labels", "channel_ids"])
def test_values_beside_names_are_called_by_them_wherever_they_stand(
    swap_at: int, key: str, write: Any, read: Any, tmp_path: Path
) -> None:
    rows = [_pairs(k, k >= swap_at) for k in range(60)]
    messages = [
        ("/temps", T0 + k * MINUTE, {key: [n for n, _ in row], "values": [v for _, v in row], "effort": []})
        for k, row in enumerate(rows)
    ]
    _, _, values, _, losses = read(write(tmp_path / "a.mcap", messages))
    assert not losses
    assert set(values) == {"/temps.values.T_front", "/temps.values.T_rear"}
    np.testing.assert_array_equal(values["/temps.values.T_front"], FRONT)
    np.testing.assert_array_equal(values["/temps.values.T_rear"], REAR)


@pytest.mark.parametrize("key", ["name", "channel", "id"])
def test_objects_of_a_list_are_called_by_their_name(key: str, write: Any, read: Any, tmp_path: Path) -> None:
    messages = [
        ("/s", T0 + k * MINUTE, {"of": [{key: n, "v": v, "unit": "degC"} for n, v in _pairs(k, k % 2 == 1)]})
        for k in range(60)
    ]
    _, _, values, _, losses = read(write(tmp_path / "a.mcap", messages))
    assert not losses
    np.testing.assert_array_equal(values["/s.of.T_front.v"], FRONT)
    np.testing.assert_array_equal(values["/s.of.T_rear.v"], REAR)


def test_a_name_that_comes_late_is_told(write: Any, read: Any, tmp_path: Path) -> None:
    """Past the messages that the first look samples, a sensor more is a loss and moves no other."""
    messages = [("/t", T0 + k * MINUTE, {"name": ["a", "b"], "v": [k / 2, -k / 2]}) for k in range(60)] + [
        ("/t", T0 + 60 * MINUTE, {"name": ["c", "a", "b"], "v": [7.5, 30.0, -30.0]})
    ]
    _, _, values, _, _ = read(write(tmp_path / "a.mcap", messages))
    np.testing.assert_array_equal(values["/t.v.a"], np.arange(61) / 2)
    np.testing.assert_array_equal(values["/t.v.b"], -np.arange(61) / 2)


def test_words_that_never_come_again_name_nothing(write: Any, read: Any, tmp_path: Path) -> None:
    messages = [
        ("/log", T0 + k * MINUTE, {"events": [{"id": f"{k}-{j}", "level": j} for j in range(2)]}) for k in range(60)
    ]
    _, _, values, _, _ = read(write(tmp_path / "a.mcap", messages))
    assert "/log.events[0].level" in values
