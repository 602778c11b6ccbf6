"""Flags of long streams: judged window by window they are those of the whole stream."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from store_fakes import daq, write_log

from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.event import QualityEvent
from thermodata.calibration.quality.flags import flag_stream
from thermodata.plugin import Array, Float1D, Int1D
from thermodata.schema.files.campaign import Channel
from thermodata.schema.flag import Flag
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.store.raw import writer
from thermodata.store.tidy.flags.in_windows import windows
from thermodata.store.tidy.flags.in_windows.windows import Joined
from thermodata.store.tidy.plan.plan import Bound
from thermodata.store.tidy.values.chunk import Column

N, SIZE, MARGIN = 24_000, 4000, 600
QUANTITIES = {"dZ": "displacement", "T_a": "temperature", "T_b": "temperature", "T_c": "temperature"}


def clock() -> Int1D:
    return np.arange(N) * 1_000_000_000 + 1_770_000_000_000_000_000


def sound() -> dict[str, Float1D]:
    rng = np.random.default_rng(1)
    s = np.arange(N)
    return {
        "dZ": 20 * np.sin(s / 3000) + 0.1 * rng.standard_normal(N),
        **{
            f"T_{c}": 25 + 3 * np.sin(s / (4000 + 500 * i)) + 0.02 * rng.standard_normal(N) for i, c in enumerate("abc")
        },
    }


def whole(t: Int1D, values: dict[str, Float1D]) -> tuple[dict[str, Array], list[QualityEvent]]:
    return flag_stream(t, {n: ColumnInput(x, QUANTITIES[n]) for n, x in values.items()})


def by_windows(t: Int1D, values: dict[str, Float1D], size: int = SIZE) -> tuple[dict[str, Array], list[QualityEvent]]:
    joined = Joined()
    parts: dict[str, list[Array]] = {n: [] for n in values}
    for a in range(0, len(t), size):
        low, high = max(0, a - MARGIN), min(len(t), a + size + MARGIN)
        columns = {
            n: Column(
                Bound(n, Channel(source="daq", signal=n, quantity=QUANTITIES[n]), "daq", "main"),
                x[low:high],
                np.zeros(high - low, np.uint16),
            )
            for n, x in values.items()
        }
        for n, flags in joined.add(t[low:high], columns, a - low, min(a + size, len(t)) - low).items():
            parts[n].append(flags)
    return {n: np.concatenate(p) for n, p in parts.items()}, joined.events


def stretches(events: list[QualityEvent]) -> list[tuple[str | None, str, int, int, int]]:
    return sorted(((e.channel, e.flag, e.from_ns, e.to_ns, e.n) for e in events), key=str)


def held_across_windows(t: Int1D, x: dict[str, Float1D]) -> None:
    x["T_a"][5000:18_500] = x["T_a"][5000]


def held_over_a_border(t: Int1D, x: dict[str, Float1D]) -> None:
    x["dZ"][7990:8100] = x["dZ"][7990]


def stuck_across_windows(t: Int1D, x: dict[str, Float1D]) -> None:
    x["dZ"][6000:15_000] = -400.0


def off_until_the_end(t: Int1D, x: dict[str, Float1D]) -> None:
    x["T_b"][5200:] += 30.0


def off_for_some_windows(t: Int1D, x: dict[str, Float1D]) -> None:
    x["T_b"][5200:17_900] -= 30.0


def off_from_a_border(t: Int1D, x: dict[str, Float1D]) -> None:
    x["T_b"][8000:16_000] += 30.0


def spikes_at_borders(t: Int1D, x: dict[str, Float1D]) -> None:
    x["T_a"][[3999, 8000, 12_001]] += 12.0
    x["T_a"][15_999:16_001] -= 12.0


def gaps_at_a_border(t: Int1D, x: dict[str, Float1D]) -> None:
    t[4000:] += 90_000_000_000
    t[12_300:] += 90_000_000_000


def another_rate(t: Int1D, x: dict[str, Float1D]) -> None:
    t[:] = t[0] + np.cumsum(np.where(np.arange(N) < 9000, 1_000_000_000, 5_000_000_000)) - 1_000_000_000


def missing_over_a_border(t: Int1D, x: dict[str, Float1D]) -> None:
    x["T_c"][7950:8050] = np.nan
    x["T_c"][11_000:17_000] = np.nan


def standing_time_over_a_border(t: Int1D, x: dict[str, Float1D]) -> None:
    t[3998:4003] = t[3998]


DEFECTS = [
    held_across_windows,
    held_over_a_border,
    stuck_across_windows,
    off_until_the_end,
    off_for_some_windows,
    off_from_a_border,
    spikes_at_borders,
    gaps_at_a_border,
    another_rate,
    missing_over_a_border,
    standing_time_over_a_border,
]


@pytest.mark.parametrize("defect", DEFECTS, ids=lambda f: f.__name__)
def test_flags_and_events_do_not_depend_on_the_windows(defect: object) -> None:
    t, values = clock(), sound()
    defect(t, values)  # type: ignore[operator]
    flags, events = whole(t, values)
    assert any(f.any() for f in flags.values()) or events
    found, found_events = by_windows(t, values)
    for name in values:
        np.testing.assert_array_equal(found[name], flags[name], err_msg=name)
    assert stretches(found_events) == stretches(events)


def test_sound_data_get_no_flag_in_any_window() -> None:
    flags, events = by_windows(clock(), sound())
    assert not any(f.any() for f in flags.values())
    assert events == []


def test_what_is_off_from_the_first_window_on_is_so_in_every_later_one() -> None:
    t, values = clock(), sound()
    off_until_the_end(t, values)
    for size in (2000, 3000, 7000, N):
        flags, events = by_windows(t, values, size)
        assert np.flatnonzero(flags["T_b"] & Flag.OFFSET).tolist() == list(range(5200, N)), size
        assert [(e.flag, e.n) for e in events] == [("offset", N - 5200)], size


def test_a_smooth_reading_that_is_held_over_windows_is_told_by_its_release(
    store: Store, campaign: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = daq(6000)
    log["main"]["Z"][1500:4200] = log["main"]["Z"][1500]
    write_log(campaign.parent / "raw/one_a.npz", log)
    beside = Store(tmp_path / "beside", create=True)
    ingest(beside, campaign)
    monkeypatch.setattr(writer, "GROUP_ROWS", 100)
    monkeypatch.setattr(windows, "WINDOW_VALUES", 3000)
    monkeypatch.setattr(windows, "MARGIN_ROWS", 200)
    assert ingest(store, campaign).flags["held"] == 2700
    for query in (
        "select * from sample order by all",
        "select channel, flag, from_s, to_s, n from quality_event order by all",
    ):
        with store.reader() as one, beside.reader() as other:
            assert one.sql(query).fetchall() == other.sql(query).fetchall()


def test_more_columns_than_are_judged_together_have_the_same_flags(
    store: Store, campaign: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = daq(6000)
    log["main"]["T1"][2500:] += 30.0
    log["main"]["Z"][1000:1400] = log["main"]["Z"][1000]
    log["main"]["Z"][3000] = np.nan
    write_log(campaign.parent / "raw/one_a.npz", log)
    beside = Store(tmp_path / "beside", create=True)
    ingest(beside, campaign)
    monkeypatch.setattr(windows, "MOST_COLUMNS", 2)
    summary = ingest(store, campaign)
    assert summary.flags["offset"] == 3500
    for query in ("select * from sample order by all", "select * from quality_event order by all"):
        with store.reader() as one, beside.reader() as other:
            assert one.sql(query).fetchall() == other.sql(query).fetchall()
