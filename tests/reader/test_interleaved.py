"""Which columns part the rows of a table into series, and which only say how the machine was."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from thermodata.plugin import Array
from thermodata.reader.signals.interleaved import series_columns

S = 10**9
RNG = np.random.default_rng(18)


def words(cells: list[str]) -> Array:
    made = np.empty(len(cells), object)
    made[:] = cells
    return made


def rows(series: dict[str, np.ndarray], *, level: float = 5.0) -> tuple[np.ndarray, Array, Array]:
    """(times, words, a temperature) of series that each have times of their own [s], in the order of time."""
    every = sorted((t, k, name) for k, (name, times) in enumerate(series.items()) for t in times.tolist())
    t_ns = np.array([round(t * S) for t, _, _ in every])
    temperature = np.array([20 + level * k + t / 3600 + 0.02 * RNG.standard_normal() for t, k, _ in every])
    return t_ns, words([name for _, _, name in every]), temperature


EACH_10_S = np.arange(300) * 10.0


@pytest.mark.parametrize("header", ["host", "sensor", "entity_id", "header.frame_id", "Kostka"])
@pytest.mark.parametrize("level", [5.0, 0.0])
@pytest.mark.parametrize(
    "times",
    [
        {"a": EACH_10_S, "b": EACH_10_S},
        {"a": EACH_10_S, "b": EACH_10_S + 0.3, "c": EACH_10_S + 0.7},
        {"a": np.arange(3000) * 1.0, "b": np.arange(200) * 15.0 + 0.7},
        {"a": np.arange(3000) * 1.0, "b": np.arange(200) * 15.0},
    ],
    ids=["one time", "times of their own", "another rate", "another rate at shared times"],
)
def test_series_that_go_on_side_by_side_are_parted(header: str, level: float, times: dict[str, np.ndarray]) -> None:
    t_ns, names, temperature = rows(times, level=level)
    assert series_columns(t_ns, {header: names, "temperature": temperature}, absolute=True).tags == (header,)


def doubtful(t_ns: np.ndarray, columns: dict[str, Array]) -> tuple[str, ...]:
    parting = series_columns(t_ns, columns, absolute=True)
    assert not parting.tags
    return tuple(parting.doubtful)


def test_series_that_are_polled_in_turn_are_parted_where_their_header_names_them() -> None:
    times = {"a": np.arange(300) * 4.0, "b": np.arange(300) * 4.0 + 2}
    t_ns, names, temperature = rows(times)
    assert series_columns(t_ns, {"sensor": names, "T": temperature}, absolute=True).tags
    assert series_columns(t_ns, {"station": names, "T": temperature}, absolute=True).tags
    assert doubtful(t_ns, {"Palette": names, "X": temperature}) == ("Palette",), "a table may swing between two"
    t_ns, names, temperature = rows(times, level=0.0)
    for header in ("sensor", "host"):
        assert series_columns(t_ns, {header: names, "T": temperature}, absolute=True).tags
    assert doubtful(t_ns, {"axis": names, "T": temperature}) == ("axis",)


def test_series_that_log_on_change_are_parted_by_their_header() -> None:
    times = {name: np.cumsum(RNG.exponential(20, 200)) for name in ("hall", "bed", "door")}
    t_ns, names, temperature = rows(times)
    assert series_columns(t_ns, {"entity_id": names, "state": temperature}, absolute=True).tags == ("entity_id",)


def test_a_sensor_that_is_read_in_bursts_is_parted() -> None:
    t_ns = np.arange(400) * S
    names = words([("front", "rear")[k // 10 % 2] for k in range(400)])
    jumps = np.where(names == "front", 20.0, 25.0) + t_ns / 1e12
    assert series_columns(t_ns, {"sensor": names, "T": jumps}, absolute=True).tags == ("sensor",)
    assert doubtful(t_ns, {"sensor": names, "T": t_ns / 1e12}) == ("sensor",)


def test_ids_that_are_numbers_are_parted_where_header_or_values_say_so() -> None:
    t_ns, names, temperature = rows({"1": EACH_10_S, "2": EACH_10_S})
    ids = np.array([int(n) for n in names])
    assert series_columns(t_ns, {"Sensor-ID": ids, "T": temperature}, absolute=True).tags == ("Sensor-ID",)
    assert series_columns(t_ns, {"Nr": ids, "T": temperature}, absolute=True).tags == ("Nr",)
    t_ns, names, temperature = rows({"1": EACH_10_S, "2": EACH_10_S}, level=0.0)
    assert not series_columns(t_ns, {"Nr": ids, "T": temperature}, absolute=True).tags, "a count within the second"


def test_a_host_with_several_sensors_needs_both() -> None:
    names = {f"{h} {s}": EACH_10_S + k / 10 for k, (h, s) in enumerate((h, s) for h in "AB" for s in ("in", "bed"))}
    t_ns, both, temperature = rows(names)
    parted = list(zip(*(name.split() for name in both), strict=True))
    columns = {"host": words(list(parted[0])), "sensor": words(list(parted[1])), "T": temperature}
    assert series_columns(t_ns, columns, absolute=True).tags == ("host", "sensor")


def test_names_that_follow_each_other_are_parted_where_times_have_dates() -> None:
    t_ns = np.tile(np.arange(100) * S, 2)
    columns = {"where": words(["front"] * 100 + ["rear"] * 100), "T": np.arange(200.0)}
    assert series_columns(t_ns, columns, absolute=True).tags == ("where",)
    assert not series_columns(t_ns, columns, absolute=False).tags, "two tests, of which each counts from its start"


def no_series(cells: list[str], header: str = "state", t_ns: np.ndarray | None = None, **more: np.ndarray) -> None:
    t_ns = np.arange(len(cells)) * 10 * S if t_ns is None else t_ns
    columns = {header: words(cells), "T": 20 + t_ns / 1e13 + 0.02 * RNG.standard_normal(len(cells)), **more}
    assert series_columns(t_ns, columns, absolute=True).tags == ()


SECONDS = np.arange(600) * S
JITTER = np.round(np.cumsum(np.random.default_rng(4).uniform(0.7, 1.4, 600)) * S).astype(np.int64)
SLOW = 20 + np.arange(600) / 100


def seldom(usual: str, other: str, every: int = 90) -> Array:
    return words([usual if k % every else other for k in range(600)])


@pytest.mark.parametrize(
    ("t_ns", "columns"),
    [
        (SECONDS, {"Status": seldom("gültig", "ungültig"), "dZ": np.where(np.arange(600) % 90, SLOW, 9999.0)}),
        (SECONDS, {"Status": seldom("measured", "replaced"), "dZ": np.where(np.arange(600) % 90, SLOW, 9999.0)}),
        (SECONDS, {"Line": seldom("MAIN.MPF", "TOOLCHG.SPF", 120), "dZ": SLOW, "T_Luft": SLOW - 1}),
        (SECONDS, {"Probe": (np.arange(600) % 50 < 3).astype(np.int64), "dZ": SLOW}),
        (SECONDS, {"Fühler": np.round(SLOW + 0.3 * RNG.standard_normal(600)).astype(np.int64), "dZ": 10 * SLOW}),
        (SECONDS, {"Sensor": words(["connected" if k % 50 > 3 else "lost" for k in range(600)]), "dZ": SLOW}),
        (SECONDS, {"cmd": words([("left", "right")[k % 2] for k in range(600)]), "X": 400.0 * (np.arange(600) % 2)}),
        (JITTER, {"Machine": words(list(RNG.choice(["idle", "cut"], 600))), "dZ": SLOW}),
        (JITTER, {"Station": words(list(RNG.choice(["frei", "belegt"], 600))), "dZ": SLOW}),
        (JITTER, {"axis": RNG.integers(0, 2, 600), "dZ": SLOW}),
        (JITTER, {"Signal": RNG.integers(12, 20, 600), "dZ": SLOW}),
        (JITTER, {"Achse": words(list(RNG.choice(["X", "Y", "Z"], 600))), "dZ": SLOW}),
        (JITTER, {"/nc.block.name": words(list(RNG.choice(["G0", "G1", "M6"], 600))), "/nc.pos": SLOW}),
        (SECONDS // (2 * S) * 60 * S, {"Satz": words([f"N{n}" for n in RNG.integers(0, 40, 600)]), "dZ": SLOW}),
        (SECONDS // (2 * S) * 60 * S, {"Signal": RNG.integers(0, 31, 600), "dZ": SLOW}),
    ],
)
def test_a_wide_log_is_not_parted(t_ns: np.ndarray, columns: dict[str, Array]) -> None:
    assert series_columns(t_ns, columns, absolute=True).tags == ()


def test_a_state_is_none_though_the_clock_halts_and_a_power_moves_with_it() -> None:
    cells = words([str(w) for w in RNG.choice(["Kopf", "Bett"], 600)])
    power = np.where(cells == "Kopf", 3.0, 0.1)
    for steps in ([1, 1, 1, 60], [1, 1, 1, 1, 1, 1, 1, 1, 5]):
        t_ns = np.cumsum(RNG.choice(steps, 600)) * S
        assert doubtful(t_ns, {"Machine": cells, "P": power}) == ("Machine",)
    on_change = np.round(np.cumsum(RNG.exponential(5, 600)) * S).astype(np.int64)
    assert doubtful(on_change, {"Machine": cells, "P": power, "T": SLOW}) == ("Machine",)
    assert series_columns(on_change, {"Machine": cells, "T": SLOW + power, "U": power}, absolute=True).tags


def test_a_sensor_that_is_named_seldom_is_doubtful() -> None:
    t_ns = np.round(np.cumsum(RNG.exponential(5, 600)) * S).astype(np.int64)
    assert doubtful(t_ns, {"Sensor": seldom("A1", "B1", 50), "T": SLOW}) == ("Sensor",)
    assert series_columns(t_ns, {"sensor_id": seldom("A1", "B1", 50), "T": SLOW}, absolute=True).tags


def test_names_that_are_mixed_without_a_clock_of_their_own_are_doubtful() -> None:
    cells = words(list(RNG.choice(["X", "Y", "Z"], 600)))
    parting = series_columns(JITTER, {"Achse": cells, "dZ": SLOW}, absolute=True)
    assert parting.doubtful == {"Achse": ("X", "Y", "Z")}
    assert not series_columns(JITTER, {"Zustand": cells, "dZ": SLOW}, absolute=True).doubtful


def test_a_clock_that_is_set_back_when_the_job_changes_parts_nothing() -> None:
    t_ns = np.concatenate([np.arange(300), np.arange(297, 597)]) * 60 * S
    no_series(["A17"] * 300 + ["A18"] * 300, "Auftrag", t_ns)


def test_what_lies_between_two_pieces_of_a_file_is_no_step() -> None:
    """16 hosts in turn, of whom a first look sees a few rows at a time."""
    pieces = np.repeat(np.arange(7), 48)
    t_ns = (np.arange(336) + 5003 * pieces) * S
    names = words([f"plc{(k + 7 * (k // 48)) % 16:02d}" for k in range(336)])
    level = np.array([3.0 * int(name[3:]) for name in names])
    columns = {"place": names, "T": level + np.arange(336) / 1e4}
    assert series_columns(t_ns, columns, absolute=True, pieces=pieces).tags == ("place",)
    alone = {"Zustand": names, "T": SLOW[:336]}
    odd = t_ns + np.where(np.arange(336) % 16 == 3, 3 * 10**8, 0)
    assert series_columns(odd, alone, absolute=True, pieces=pieces).tags == ("Zustand",)
    assert series_columns(odd, alone, absolute=True).tags == ()


@pytest.mark.parametrize("header", ["state", "operator", "phase", "tool", "axis", "machine", "name", "item", "test"])
@pytest.mark.parametrize("kinds", [("roughing", "finishing"), ("T1", "T2", "T3"), ("Novák", "Svobodová")])
def test_words_that_change_in_blocks_are_states(header: str, kinds: tuple[str, ...]) -> None:
    no_series([kinds[k // 40 % len(kinds)] for k in range(600)], header)
    cells: list[str] = []
    while len(cells) < 600:
        cells += [kinds[int(RNG.integers(len(kinds)))]] * int(RNG.integers(3, 40))
    no_series(cells[:600], header)


@pytest.mark.parametrize("header", ["axis", "state", "tool"])
def test_words_that_change_often_in_a_table_of_one_clock_are_states(header: str) -> None:
    no_series([str(w) for w in RNG.choice(["X", "Y", "Z"], 600)], header)
    no_series([("X", "X", "Z", "Z")[k % 4] for k in range(600)], header)
    cells = [str(w) for w in RNG.choice(["coolant", "dry"], 600)]
    no_series(cells, header, power=np.array([3.0 if c == "dry" else 1.0 for c in cells]))


@pytest.mark.parametrize("kinds", [("ON", "OFF"), ("heating", "cooling"), ("Ein", "Aus"), ("+", "-")])
def test_states_that_are_called_so_are_no_series_however_they_change(kinds: tuple[str, str]) -> None:
    cells = [kinds[k % 2] for k in range(400)]
    no_series(cells, power=np.array([3.0 if c == kinds[0] else 0.1 for c in cells]))


def test_events_among_the_rows_of_a_rate_are_no_series() -> None:
    at = np.sort(RNG.uniform(0, 6000, 60))
    t = np.sort(np.concatenate([np.arange(600) * 10.0, at]))
    no_series(["alarm 700012" if x in at else "every 10 s" for x in t], "why", np.array([round(x * S) for x in t]))


def test_rows_under_coarse_stamps_are_no_series() -> None:
    t_ns = np.arange(600) // 6 * 60 * S
    no_series([("roughing", "finishing")[k // 40 % 2] for k in range(600)], "phase", t_ns)
    no_series([str(w) for w in RNG.choice(["roughing", "finishing"], 600)], "phase", t_ns)


def test_speeds_and_steps_are_no_names() -> None:
    speed = np.array([0, 3000.0])[np.arange(600) // 7 % 2]
    step = (np.arange(600) // 25 + 1).astype(np.int64)
    no_series(["a"] * 600, "id", speed=speed, step=step)
    at = np.cumsum(RNG.exponential(20, 600))
    power = speed / 1000
    no_series(["a"] * 600, "id", np.array([round(x * S) for x in at]), speed=speed[RNG.permutation(600)], power=power)


def test_times_of_a_clock_that_is_set_back_within_a_word_part_nothing() -> None:
    t_ns = np.concatenate([np.arange(300), np.arange(100, 400)]) * S
    no_series(["warm"] * 250 + ["cold"] * 350, "state", t_ns)
    assert all(b - a == S for a, b in pairwise(t_ns[:300].tolist()))


def numbered(times: dict[str, np.ndarray], level: float = 5.0) -> tuple[np.ndarray, Array, Array]:
    t_ns, names, temperature = rows(times, level=level)
    return t_ns, np.array([float(name) for name in names]), temperature


IN_TURN = {"1": EACH_10_S, "2": EACH_10_S + 3.3}


@pytest.mark.parametrize(
    "header", ["ch", "Sensor Nr", "slave", "port", "probe_no", "unit_id", "addr", "Fuehler", "rom_id", "Serial No."]
)
def test_numbers_whose_header_says_which_sensor_it_is_part_rows(header: str) -> None:
    t_ns, numbers, temperature = numbered(IN_TURN)
    assert series_columns(t_ns, {header: numbers, "T": temperature}, absolute=True).tags == (header,)
    texts = words([f"0x4{int(n)}" for n in numbers])
    assert series_columns(t_ns, {header: texts, "T": temperature}, absolute=True).tags == (header,)


@pytest.mark.parametrize("header", ["unit", "n", "k"])
def test_numbers_that_come_in_turn_and_move_all_values_are_doubtful(header: str) -> None:
    t_ns, numbers, temperature = numbered(IN_TURN)
    assert doubtful(t_ns, {header: numbers, "T": temperature}) == (header,)
    polled = {"1": np.arange(300) * 4.0, "2": np.arange(300) * 4.0 + 2}
    t_ns, numbers, temperature = numbered(polled)
    assert doubtful(t_ns, {header: numbers, "T": temperature}) == (header,)


def test_numbers_in_turn_that_move_nothing_are_counters() -> None:
    t_ns, numbers, temperature = numbered(IN_TURN, level=0.0)
    parting = series_columns(t_ns, {"k": numbers, "T": temperature}, absolute=True)
    assert not parting.tags
    assert not parting.doubtful


def test_a_speed_that_stands_for_minutes_is_no_id() -> None:
    t_s = np.arange(1200) * 1.0
    speed = np.where(t_s // 120 % 2 > 0, 3000.0, 0.0)
    parting = series_columns(
        np.rint(t_s * S).astype(np.int64), {"n": speed, "P": speed / 10 + t_s / 1e4}, absolute=True
    )
    assert not parting.tags
    assert not parting.doubtful
