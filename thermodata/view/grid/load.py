"""From a store to the data that models are fitted to: every test on one uniform, anti-aliased grid.

A bin's value is the mean of its valid samples, states are held, and bin k stands at t_s = k * step_s, its start.
Drivers (every quantity but displacement, tilt and angle) are interpolated over gaps of up to BRIDGE_S, or
INTERPOLATED_PERIODS of a slow source, and carry their nearest value that far at both ends: a filter over them
can't run through a hole. Between two signs of what heats either way its size is interpolated. Displacements, tilts
and angles are NaN and invalid wherever a bin has no valid sample, so no displacement that was made up is ever fitted
or scored. A history before the window comes first, with negative t_s and in_window False.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.errors import UsageError, unknown_channel, unknown_name
from thermodata.plugin import Bool1D, Float1D
from thermodata.schema.units.quantity import MEASURED, UNDIRECTED
from thermodata.store.catalogue.data_version import joined, versions
from thermodata.view.grid.at_work import with_limits
from thermodata.view.grid.bins import Binned, Series, bin_tests
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData
from thermodata.view.grid.describe import channel_infos, describe_tests
from thermodata.view.grid.fill import bridge, hold, on_grid, reach_bins
from thermodata.view.grid.recorded import Recorded, recorded_channels

if TYPE_CHECKING:
    from thermodata.store import Store

MAX_BINS = 20_000_000
# a sensor that failed in so small a share of its tests, and is sound in so many, is a witness in the others
MOST_FAILED, LEAST_SOUND = 0.25, 3


def load_dataset(
    store: Store | str | Path, campaigns: str | Sequence[str], step_s: float, channels: Collection[str] | None = None
) -> Dataset:
    """All tests of the campaigns that have data, in the order of the campaign files.

    step_s: [s] of the grid, > 0. channels: only these (default: all that are numbers).
    Raises UsageError for a step that is not positive, and for a campaign or channel that the store has not.
    """
    if not step_s > 0 or not np.isfinite(step_s):
        raise UsageError(
            "a step is positive",
            expected="seconds, for example 30",
            got=str(step_s),
            hint="30 s to 5 min suit what is thermal",
        )
    wanted = [campaigns] if isinstance(campaigns, str) else list(dict.fromkeys(campaigns))
    with _as_store(store).reader() as con:
        found = versions(con)
        for campaign in wanted:
            if campaign not in found:
                raise unknown_name("campaign", campaign, list(found))
        infos = channel_infos(con, wanted)
        _check_channels(channels, infos)
        only = None if channels is None else set(channels)
        shifted = {(*key, name) for key, table in infos.items() for name, info in table.items() if info.shifted}
        binned = bin_tests(con, wanted, step_s, lambda name: only is None or name in only, shifted)
        recorded = recorded_channels(con, wanted, {key: one.zero_ns for key, one in binned.items()})
        tests = with_limits(
            _test_data(row, binned[row["campaign"], row["test"]], infos, recorded, step_s)
            for row in describe_tests(con, wanted)
            if (row["campaign"], row["test"]) in binned
        )
    return Dataset(float(step_s), tests, union_of(tests), joined(found, wanted))


def data_version(store: Store, campaigns: Sequence[str]) -> str:
    """Of the data of some campaigns as they are now: as their `Dataset` has it; '' where one of them is gone."""
    with store.reader() as con:
        return joined(versions(con), campaigns)


def union_of(tests: Iterable[TestData]) -> dict[str, ChannelInfo]:
    """The channels of some tests, by name. A sensor that failed in one test of many is sound in the others."""
    each: dict[str, list[ChannelInfo]] = {}
    for test in tests:
        for name, info in test.channels.items():
            each.setdefault(name, []).append(info)
    union = {}
    for name, infos in each.items():
        failed = [info.faulty for info in infos if info.faulty is not None]
        sound = len(infos) - len(failed)
        mostly = sound >= LEAST_SOUND and len(failed) <= MOST_FAILED * len(infos)
        declared = all(info.clock_declared for info in infos)
        faulty = None if mostly or not failed else failed[0]
        is_mask = any(info.is_mask for info in infos)
        shifted = any(info.shifted for info in infos)
        union[name] = replace(infos[0], faulty=faulty, clock_declared=declared, is_mask=is_mask, shifted=shifted)
    return union


def _as_store(store: Store | str | Path) -> Store:
    from thermodata.store import Store

    return Store(store) if isinstance(store, str | Path) else store


def _check_channels(channels: Collection[str] | None, infos: Mapping[tuple[str, str], Mapping[str, Any]]) -> None:
    known = {name for table in infos.values() for name in table}
    for name in channels or ():
        if name not in known:
            raise unknown_channel(name, sorted(known))


def _test_data(
    row: Mapping[str, Any],
    binned: Binned,
    infos: Mapping[tuple[str, str], Mapping[str, ChannelInfo]],
    recorded: Mapping[tuple[str, str], Mapping[str, Recorded]],
    step_s: float,
) -> TestData:
    size = binned.last - binned.first + 1
    if size > MAX_BINS:
        raise UsageError(
            f"a step of {step_s:g} s makes {size} points of test '{row['test']}'",
            expected=f"at most {MAX_BINS}",
            hint="choose a longer step",
        )
    known = infos.get((row["campaign"], row["test"]), {})
    names = [n for n in known if n in binned.series] + [n for n in binned.series if n not in known and not known]
    channels = {n: known.get(n, ChannelInfo(n, "displacement", "um", sign="unknown")) for n in names}
    held = {n for n in names if binned.series[n].stands is not None}
    channels = {n: replace(info, held=True) if n in held else info for n, info in channels.items()}
    t_s: Float1D = np.arange(binned.first, binned.last + 1, dtype=np.float64) * np.float64(step_s)
    values: dict[str, Float1D] = {}
    valid: dict[str, Bool1D] = {}
    for name in names:
        values[name], valid[name] = _on_grid(binned.series[name], binned, channels[name].quantity, size, step_s)
    return TestData(
        campaign=row["campaign"],
        test=row["test"],
        kind=row["kind"],
        role=row["role"],
        t_s=t_s,
        values=values,
        valid=valid,
        in_window=t_s >= -1e-9,
        conditions=row["conditions"],
        phases=row["phases"],
        start_state=row["start_state"],
        zero_s=row["zero_s"],
        start_unix_s=None if row["clock"] == "relative" else binned.zero_ns / 1e9,
        machine=row["machine"],
        channels=channels,
        logged={
            name: _between_times_s(binned.series[name], step_s) for name in names if not binned.series[name].on_change
        },
        recorded=recorded.get((row["campaign"], row["test"]), {}),
    )


def _between_times_s(series: Series, step_s: float) -> tuple[float, float]:
    """Between which times its valid samples lie [s]."""
    if not series.k.size:
        return np.inf, -np.inf
    return float(series.k.min()) * step_s, float(series.k.max() + 1) * step_s


def _on_grid(series: Series, binned: Binned, quantity: str, size: int, step_s: float) -> tuple[Float1D, Bool1D]:
    if series.stands is not None:
        value = hold(series.k, series.value, series.stands, binned.first, size)
        return value, np.isfinite(value)
    value = on_grid(series.k, series.value, binned.first, size)
    if quantity not in MEASURED:
        value = bridge(value, reach_bins(series.period_s, step_s), quantity in UNDIRECTED)
    return value, np.isfinite(value)
