"""Arrays whose elements have names: in an array beside them, or in a field of each element."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermodata.reader.finding.match import NoSignalError, match_signal

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


def _beside(k: int, swapped: bool) -> dict[str, Any]:
    pairs = _pairs(k, swapped)
    return {"name": [n for n, _ in pairs], "values": [v for _, v in pairs]}


@pytest.mark.parametrize("nested", [False, True])
def test_a_place_that_stands_is_another_spelling_of_the_name(
    nested: bool, write: Any, read: Any, tmp_path: Path
) -> None:
    """Campaigns that were written when arrays went by their places read what they read then."""

    def body(k: int) -> dict[str, Any]:
        return {"of": [{"name": n, "v": v} for n, v in _pairs(k, False)]} if nested else _beside(k, False)

    path = write(tmp_path / "a.mcap", [("/t", T0 + k * MINUTE, body(k)) for k in range(60)])
    found = read(path)[0].signals
    first, second = ("/t.of[0].v", "/t.of[1].v") if nested else ("/t.values[0]", "/t.values[1]")
    own = ["/t.of.T_front.v", "/t.of.T_rear.v"] if nested else ["/t.values.T_front", "/t.values.T_rear"]
    assert [match_signal(one, found).name for one in (first, second)] == own


def test_a_place_that_changes_is_no_name_and_the_error_says_which_there_are(
    write: Any, read: Any, tmp_path: Path
) -> None:
    messages = [("/t", T0 + k * MINUTE, _beside(k, k >= 45)) for k in range(60)]
    signals = read(write(tmp_path / "a.mcap", messages))[0].signals
    with pytest.raises(NoSignalError, match=r"change their places, .* go by their names: /t\.values\.T_front") as error:
        match_signal("/t.values[0]", signals)
    assert "did you mean" not in str(error.value)


@pytest.mark.parametrize("key", ["channels", "probe", "sensors"])
def test_whole_numbers_are_readings_and_no_names(key: str, write: Any, read: Any, tmp_path: Path) -> None:
    """Tenths of a degree that stand for a while, beside their states."""
    messages = [
        ("/daq", T0 + k * MINUTE, {key: [215 + k // 10, 223 + k // 8], "valid": [True, True]}) for k in range(60)
    ]
    _, _, values, _, losses = read(write(tmp_path / "a.mcap", messages))
    assert not losses
    assert list(values[f"/daq.{key}[0]"]) == [215 + k // 10 for k in range(60)]
    assert "/daq.valid[1]" in values


def test_numbers_of_sensors_are_names(write: Any, read: Any, tmp_path: Path) -> None:
    messages = [
        ("/can", T0 + k * MINUTE, {"of": [{"id": n, "v": 10 * n + k / 8} for n in ((7, 3) if k % 2 else (3, 7))]})
        for k in range(60)
    ]
    _, _, values, _, _ = read(write(tmp_path / "a.mcap", messages))
    np.testing.assert_array_equal(values["/can.of.3.v"], 30 + np.arange(60) / 8)


@pytest.mark.parametrize(("nameless", "named"), [(0, True), (5, True), (7, False)])
@pytest.mark.parametrize("beside", [False, True])
def test_a_tenth_of_the_messages_may_lack_names(
    nameless: int, named: bool, beside: bool, write: Any, read: Any, tmp_path: Path
) -> None:
    def body(k: int) -> dict[str, Any]:
        if beside:
            return {**_beside(k, False), **({"name": []} if k % 8 == 1 and k // 8 < nameless else {})}
        pairs = [{"name": n, "v": v} for n, v in _pairs(k, False)]
        return {"of": [{"v": 1.5}, *pairs[1:]] if k % 8 == 1 and k // 8 < nameless else pairs}

    messages = [("/t", T0 + k * MINUTE, body(k)) for k in range(60)]
    _, _, values, _, _ = read(write(tmp_path / "a.mcap", messages))
    assert (("/t.values.T_front" if beside else "/t.of.T_front.v") in values) == named
