"""Signals that are written at a steady beat, and what is written on change."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.plugin import Int1D
from thermodata.reader.signals import beat
from thermodata.reader.signals.beat import Beat
from thermodata.reader.signals.events import HeldRows
from thermodata.schema.flag import Flag

S = 10**9


def beat_of(t_ns: Int1D, texts: list[str]) -> Beat | None:
    return beat.beat_of(t_ns, texts, np.array(texts, np.float64))


def every(s: float, n: int) -> Int1D:
    return (np.arange(n) * s * S).astype(np.int64)


def noise(n: int, digits: int = 6) -> list[str]:
    return [f"{20 + x:.{digits}f}" for x in np.random.default_rng(3).normal(0, 0.01, n)]


def test_what_writes_a_value_again_at_a_beat_has_one() -> None:
    assert beat_of(every(10, 100), noise(100, 2)) == Beat(100 * S, rests=False)
    assert beat_of(every(10, 100), ["21"] * 100) == Beat(100 * S, rests=False)


def test_noise_at_a_beat_has_one_but_may_rest_at_zero() -> None:
    assert beat_of(every(10, 100), noise(100)) == Beat(100 * S, rests=True)
    ended = Beat(100 * S, rests=True).ended(np.array([0.0, 3.0, 3.0]), np.array([500, 500, 50]) * S)
    assert ended.tolist() == [False, True, False]


def feed(moves: int, digits: int = 3) -> tuple[Int1D, list[str]]:
    """A feed that is written each 10 s while its axis moves, for ten minutes, and each ten minutes while it rests, for
    half an hour."""
    rng = np.random.default_rng(5)
    t_s, texts = [0], ["0"]
    for _ in range(moves):
        t_s += [t_s[-1] + 10 * (k + 1) for k in range(60)]
        texts += [f"{9 + x:.{digits}f}" for x in rng.normal(0, 0.1, 60)]
        t_s += [t_s[-1] + x for x in (10, 610, 1210, 1810)]
        texts += ["0"] * 4
    return np.array(t_s) * S, texts


@pytest.mark.parametrize("digits", [1, 3])  # of one digit, the moving feed comes again by chance as well
def test_a_heartbeat_of_what_rests_is_its_beat(digits: int) -> None:
    assert beat_of(*feed(6, digits)) == Beat(6000 * S, rests=False)


def test_equal_silences_of_what_is_written_again_at_its_beat_are_no_heartbeat() -> None:
    t_ns = every(10, 300) + np.arange(300) // 60 * 600 * S  # a sensor of one digit, lost for ten minutes four times
    assert beat_of(t_ns, ["21"] * 300) == Beat(100 * S, rests=False)
    assert beat_of(t_ns, noise(300, 2)) == Beat(100 * S, rests=False)


def stops(n: int, size: int, pause_s: float) -> Int1D:
    """Rows of 0.1 s with a pause after each `size`: an axis that stands between its moves."""
    return every(0.1, n) + (np.arange(n) // size * pause_s * S).astype(np.int64)


@pytest.mark.parametrize(
    ("t_ns", "texts"),
    [
        (stops(300, 100, 60), [f"{k % 100}.5" for k in range(300)]),  # an axis, on change
        (stops(300, 60, 60), noise(300)),  # a noisy speed that stands five times
        (np.cumsum(np.random.default_rng(1).integers(1, 40, 100)) * S, noise(100, 1)),  # at no beat
        (every(10, 100), [f"{20 + k / 10}" for k in range(100)]),  # that rises: nobody can tell
        (every(10, 20), ["21"] * 20),  # too few
        (np.zeros(100, np.int64), ["21"] * 100),
    ],
)
def test_what_may_be_written_on_change_has_none(t_ns: Int1D, texts: list[str]) -> None:
    assert beat_of(t_ns, texts) is None


def rows(beats: dict[str, Beat], split: bool) -> tuple[list[float], list[int]]:
    """a: each second but for 6 to 19; b: each second. In one block, or in two."""
    table = HeldRows[int]({"a": "float64", "b": "float64"}, "nc", beats=beats)
    values, flags = [], []
    for t in range(25):
        if t < 6 or t > 19:
            table.add(t * S, "a", 20.0 + t)
        table.add(t * S, "b", 1.0)
        if t == 24 or (split and t == 12):
            block, _ = table.take(lambda stamps: np.array(stamps, np.int64))
            assert block is not None
            values += block.values["a"].tolist()
            flags += (block.flags or {}).get("a", np.zeros(block.t_ns.size)).tolist()
    return values, flags


@pytest.mark.parametrize("split", [False, True])
def test_a_value_ends_where_its_beat_is_missed(split: bool) -> None:
    values, flags = rows({"a": Beat(4 * S, rests=False)}, split)
    assert values[9] == 25.0
    assert np.isnan(values[10:20]).all()
    assert values[20:] == [40.0, 41.0, 42.0, 43.0, 44.0]
    assert flags == [0] * 10 + [int(Flag.NOT_MEASURING)] * 10 + [int(Flag.GAP)] + [0] * 4


@pytest.mark.parametrize("split", [False, True])
def test_a_value_without_a_beat_holds(split: bool) -> None:
    values, flags = rows({}, split)
    assert values[6:20] == [25.0] * 14
    assert not any(flags)
