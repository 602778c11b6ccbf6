"""What was flagged, over all tests: a row a cause, each stretch one click away, and what was lost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from starlette.requests import Request
from starlette.responses import Response

from thermodata.report.quality.page import count, share
from thermodata.report.quality.told import by_cause, faults_in_words, lost_in_words, with_reason
from thermodata.schema.flag import INVALID, Flag
from thermodata.store.tidy.flags.measured.not_measuring import ONLY
from thermodata.view.lists.alike import Alike, folded
from thermodata.view.lists.events import Flagged
from thermodata.view.lists.flag_rows import faults_told, flag_rows, lost
from thermodata.view.lists.overview import TestList, WantedTests, find_tests
from thermodata.web.command import command
from thermodata.web.render import desk_of, page

# of a cause, the worst first, and stretches of each: a page of a thousand tests would not open; theirs have the rest
MOST_TESTS, MOST_STRETCHES = 50, 20
_IDLE = Flag.NOT_MEASURING.word
_RULED_OUT = frozenset(flag.word for flag in Flag if flag & INVALID)


@dataclass(frozen=True, slots=True)
class InTest:
    """What a cause flagged in a test. alike: its stretches, of channels that have the same."""

    test: str
    n: int
    alike: tuple[Alike, ...]


@dataclass(frozen=True, slots=True)
class CauseOfFlags:
    """One cause. counts: whether its samples count all the same. overruled: why, where the campaign file overrules it.
    channels: its names, or of sources."""

    campaign: str
    flag: str
    detail: str
    counts: bool
    overruled: str | None
    n: int
    channels: tuple[str, ...]
    tests: tuple[InTest, ...]

    @property
    def idle(self) -> bool:
        """Whether it has samples only while its tests do not measure."""
        return self.flag == _IDLE or self.detail == ONLY

    @property
    def timed(self) -> bool:
        """Whether any of its stretches begins and ends somewhere."""
        return any(one.from_s == one.from_s for t in self.tests for a in t.alike for one in a.stretches)


def show(request: Request) -> Response:
    """GET /quality: campaign."""
    desk, campaign = desk_of(request), request.query_params.get("campaign", "")
    store = desk.store()
    tests = find_tests(store, WantedTests(campaign=campaign, per_page=1_000_000))
    own = campaign or None
    causes = _causes(flag_rows(store, own))
    asked = ["-c", campaign] if campaign else []
    return page(
        request,
        "quality.html.j2",
        title="Quality",
        command=command(desk.store_path, "quality", *asked),
        campaign=campaign,
        campaigns=tests.campaigns,
        headline=_headline(tests, sum(c.n for c in causes if c.flag == _IDLE)),
        tests=len(tests.rows),
        ruled_out=[c for c in causes if not c.counts and not c.idle],
        idle=[c for c in causes if not c.counts and c.idle],
        told=[c for c in causes if c.counts],
        losses=lost_in_words(lost(store, own)),
        faults=faults_in_words(faults_told(store, own)),
        most_tests=MOST_TESTS,
        most=MOST_STRETCHES,
    )


def _headline(tests: TestList, idle: int) -> str:
    """How much a defect rules out, and how much was not measured, which is none. idle: samples that were not."""
    there = [t for t in tests.rows if t.valid is not None]
    samples = sum(t.samples for t in there)
    gone = round(sum(t.samples * (1 - (t.valid or 0.0)) for t in there))
    if not samples:
        return "No samples"
    if not gone:
        return f"All of {count(samples)} samples count"
    idle = min(idle, gone)
    defect = f"{share(gone - idle, samples)} of {count(samples)} samples" if gone > idle else "none"
    if not idle:
        return f"{defect} do not count"
    of = "" if gone > idle else f" of {count(samples)} samples"
    return f"A defect in {defect}; {share(idle, samples)}{of} {'were' if idle > 1 else 'was'} not measured"


def _causes(rows: Sequence[Mapping[str, Any]]) -> list[CauseOfFlags]:
    """Those that rule out most samples first."""
    found = [_cause(one) for one in by_cause([with_reason(row) for row in rows])]
    return sorted(found, key=lambda one: -one.n)


def _cause(one: Mapping[str, Any]) -> CauseOfFlags:
    rows: Sequence[Mapping[str, Any]] = one["rows"]
    overruled = rows[0]["overruled"]
    by_test: dict[str, list[Mapping[str, Any]]] = {}
    for row in rows:
        by_test.setdefault(row["test"], []).append(row)
    tests = [
        InTest(test, sum(r["n"] or 0 for r in some), tuple(folded(map(Flagged.of_row, some))))
        for test, some in by_test.items()
    ]
    return CauseOfFlags(
        one["campaign"],
        one["flag"],
        one["detail"] or "",
        one["flag"] not in _RULED_OUT or overruled is not None,
        overruled,
        one["n"],
        tuple(dict.fromkeys(row["channel"] or row["source"] or "all channels" for row in rows)),
        tuple(sorted(tests, key=lambda t: -t.n)),
    )
