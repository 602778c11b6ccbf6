"""What of each channel does not count in a test, and which sensors are judged faulty: from the quality events."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from thermodata.schema.flag import CONSTANT, INVALID, NOT_FLAGGED, OVERRULED, Flag

if TYPE_CHECKING:
    import duckdb

Key = tuple[str, str]
FAULTY_SHARE = 0.2  # of a test: a channel that lost more of it is no witness
# a sensor that is off, or does not move any more, has failed, however soon it is mended
_FAILED = ("offset", "stuck")
_THROUGHOUT = 1 - 1e-9
# events that say nothing against a sensor: a blank between the rows of a slower logger is no loss
_NO_FAULT = (OVERRULED, "only while not measuring", NOT_FLAGGED, "no number")
_COUNTS_NOT = frozenset(f.word for f in Flag if f & INVALID and f != Flag.NOT_MEASURING)


@dataclass(slots=True)
class Flagged:
    """Of a channel in a test. lost: share of its samples that flags rule out, at most 1. flags: flag -> share.
    constant: share that is off by one number in all tests. while_measuring: the share of the samples that the test's
    `measuring` leaves, None where it declares none or little is lost."""

    flags: dict[str, float] = field(default_factory=dict)
    constant: float = 0.0
    while_measuring: float | None = None

    @property
    def shifted(self) -> bool:
        """Whether it is off by one number through the whole test, so that what counts from its start is sound."""
        return self.constant >= _THROUGHOUT and self.flags.get("offset", 0.0) == self.constant

    @property
    def lost(self) -> float:
        """Share of the samples that flags rule out, for whatever counts from the test's start."""
        return min(1.0, sum(self._counting().values()))

    @property
    def lost_while_measuring(self) -> float:
        """The same of the samples that the test measures: what comes before and after is lost to no flag."""
        return self.lost if self.while_measuring is None else self.while_measuring

    @property
    def mask(self) -> int:
        """The flags that rule samples out."""
        return sum(int(Flag[f.upper()]) for f in self._counting())

    def _counting(self) -> dict[str, float]:
        return {f: share for f, share in self.flags.items() if not (self.shifted and f == "offset")}

    @property
    def faulty(self) -> str | None:
        """Which flag judges the sensor faulty; None where none does."""
        flags = self._counting()
        failed = [f for f in _FAILED if f in flags]
        if not failed and self.lost_while_measuring > FAULTY_SHARE:
            failed = sorted(flags, key=lambda f: -flags[f])[:1]
        return failed[0].replace("_", " ") if failed else None


def flagged_channels(con: duckdb.DuckDBPyConnection, campaigns: Sequence[str]) -> dict[Key, dict[str, Flagged]]:
    """(campaign, test) -> channel -> what of it does not count; only channels that lost something. What the campaign
    file overrules, what happened only while the test did not measure, and blanks are not counted."""
    rows = con.execute(
        "select e.campaign, e.test, e.source, e.stream, e.channel, lower(e.flag) as flag, sum(e.n) as n, "
        "any_value(f.rows) as rows, coalesce(sum(e.n) filter (where ends_with(e.detail, ?)), 0) as constant "
        "from quality_event e join (select campaign, test, source, stream, sum(rows) as rows "
        "from file where layer = 'tidy' group by all) f using (campaign, test, source, stream) "
        "where list_contains(?, e.campaign) "
        + "".join("and not starts_with(coalesce(e.detail, ''), ?) " for _ in _NO_FAULT)
        + "group by all",
        [CONSTANT, list(campaigns), *_NO_FAULT],
    ).fetchall()
    members = con.execute(
        "select distinct campaign, test, source, stream, channel from channel where list_contains(?, campaign)",
        [list(campaigns)],
    ).fetchall()
    of_stream: dict[tuple[str, ...], list[str]] = {}
    for *member, channel in members:
        of_stream.setdefault(tuple(member), []).append(channel)
    found: dict[Key, dict[str, Flagged]] = {}
    for campaign, test, source, stream, channel, flag, n, total, constant in rows:
        if flag not in _COUNTS_NOT or not n or not total:
            continue
        for name in [channel] if channel else of_stream.get((campaign, test, source, stream), []):
            one = found.setdefault((campaign, test), {}).setdefault(name, Flagged())
            one.flags[flag] = one.flags.get(flag, 0.0) + n / total
            one.constant += constant / total if flag == "offset" else 0.0
    _look_while_measuring(con, found)
    return found


def _look_while_measuring(con: duckdb.DuckDBPyConnection, found: Mapping[Key, Mapping[str, Flagged]]) -> None:
    """Counts the samples of channels that lost much in tests that measure at times only: an event may begin while the
    test measures and go on behind it."""
    timed = set(con.execute("select campaign, test from test where measuring is not null").fetchall())
    for (campaign, test), channels in found.items():
        for name, one in channels.items():
            if (campaign, test) not in timed or one.lost <= FAULTY_SHARE:
                continue
            row = con.execute(
                "select count(*), count(*) filter (where flag & $mask <> 0) from sample where campaign = $campaign "
                "and test = $test and channel = $channel and coalesce(flag, 0) & $outside = 0",
                {
                    "campaign": campaign,
                    "test": test,
                    "channel": name,
                    "mask": one.mask,
                    "outside": int(Flag.NOT_MEASURING),
                },
            ).fetchone()
            measured, lost = row or (0, 0)
            one.while_measuring = lost / measured if measured else 0.0
