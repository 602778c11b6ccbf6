"""What was flagged in a test, and its named stretches, as rows for a picture."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from thermodata.store.base.connection import fetch
from thermodata.store.tidy.flags.measured.not_measuring import ONLY
from thermodata.view.lists.not_measured import not_measured

if TYPE_CHECKING:
    from thermodata.store import Store

_MOST = 2_000


@dataclass(frozen=True, slots=True)
class Flagged:
    """A stretch of a channel with one flag [s]. n: samples. channel: '' where all channels of a source have it."""

    channel: str
    source: str
    flag: str
    from_s: float
    to_s: float
    n: int
    detail: str

    @property
    def idle(self) -> bool:
        """Whether it stands for single samples between the measuring phases, with anything between the first and the
        last of them: no stretch to draw."""
        return self.detail == ONLY

    @classmethod
    def of_row(cls, row: Mapping[str, Any]) -> Flagged:
        """A row of `quality_event`. One that is of the whole test begins and ends nowhere: NaN."""
        start = float("nan") if row["from_s"] is None else row["from_s"]
        end = start if row["to_s"] is None else row["to_s"]
        return cls(
            row["channel"] or "", row["source"] or "", row["flag"], start, end, row["n"] or 0, row["detail"] or ""
        )


@dataclass(frozen=True, slots=True)
class About:
    """A test as the catalogue has it. phases: name -> (from, to) [s]. flagged: in order of time, at most 2,000; later:
    how many more there are behind these. machine: its id."""

    row: dict[str, Any]
    phases: dict[str, tuple[float, float]]
    flagged: tuple[Flagged, ...]
    looks: int
    open_in: tuple[str, ...] = ()
    machine: str | None = None
    later: int = 0


def about_test(store: Store, campaign: str, test: str) -> About:
    """looks: how often its lock was opened. open_in: models that were fitted to it, or checked on it, while it was
    open."""
    from thermodata.store.catalogue.models.looks import locked_looks, open_in

    own = [campaign, test]
    with store.reader() as con:
        row = fetch(con, "select * from test where campaign = ? and test = ?", own)[0]
        machines = fetch(con, "select machine from machine where campaign = ? and test = ?", own)
        phases = fetch(con, "select phase, from_s, to_s from phase where campaign = ? and test = ?", own)
        events = fetch(
            con,
            "select channel, source, flag, from_s, to_s, n, detail, count(*) over () as every from quality "
            f"where campaign = ? and test = ? and from_s is not null order by from_s, channel limit {_MOST}",
            own,
        )
    later = events[0]["every"] - len(events) if events else 0
    events = sorted([*events, *not_measured(store, campaign, test)], key=lambda e: (e["from_s"], e["channel"] or ""))
    return About(
        row,
        {p["phase"]: (p["from_s"], p["to_s"]) for p in phases},
        tuple(map(Flagged.of_row, events)),
        locked_looks(store, campaign, test),
        tuple(open_in(store, [campaign]).get((campaign, test), ())),
        machines[0]["machine"] if machines else None,
        later,
    )
