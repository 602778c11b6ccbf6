"""A window that cuts off a start in which the machine was driven is said, and only where nobody said how lags begin."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from store_fakes import daq, times, write_log

from thermodata.store import Store
from thermodata.store.ingest.run import ingest


def told(store: Store, campaign: Path, more: str, ran_s: int, from_s: int = 100) -> list[str]:
    """Notes of a start that was cut off. more: of the test; ran_s: how long the spindle ran, from from_s on."""
    log = daq()
    write_log(campaign.parent / "raw/one_a.npz", log)
    n = 240
    speed = np.zeros(n)
    speed[from_s // 5 : (from_s + ran_s) // 5] = 6000
    speed[200:] = 9000
    write_log(campaign.parent / "raw/one.nc.npz", {"nc": {"t_ns": times(n, 5.0), "n": speed}})
    campaign.write_text(
        campaign.read_text().replace("conditions: {speed: 9000 rpm}}", f"conditions: {{speed: 9000 rpm}}{more}}}", 1)
    )
    return [n for n in ingest(store, campaign).notes if "cuts off a start" in n]


@pytest.mark.parametrize(
    ("more", "ran_s", "from_s", "said"),
    [
        (", window: [10 min, 20 min]", 60, 100, True),
        (", window: [10 min, 20 min]", 50, 100, False),  # a jog
        (", window: [10 min, 20 min]", 300, 605, False),  # within the test
        (", window: [10 min, 20 min], history: recording", 300, 100, False),
        (", window: [10 min, 20 min], history: test", 300, 100, False),
        (", window: [10 min, 20 min], start_state: warm", 300, 100, False),
        ("", 300, 100, False),
    ],
)
def test_a_start_in_which_the_spindle_ran_is_asked(
    store: Store, campaign: Path, more: str, ran_s: int, from_s: int, said: bool
) -> None:
    notes = told(store, campaign, more, ran_s, from_s)
    assert bool(notes) == said
    assert all("in which speed ran" in n and "history: recording" in n for n in notes)
