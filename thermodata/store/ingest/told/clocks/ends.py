"""When the logs of a test begin and end, and how two of them stand beside each other in all tests."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.clock.source_clock import recorded

Rows = Mapping[str, Iterable[Mapping[str, Any]]]  # test -> its rows of the table `source`
PAUSED_S = "paused_s"  # of a row: how long it logged nothing in between
LASTS_S = "lasts_s"  # of a row: from its first to its last recorded time; absent where nothing tells it
LEAST_S = 120.0  # by which two logs stand apart; people switch two loggers on within it


@dataclass(frozen=True, slots=True)
class LogEnds:
    """Of one source in one test [s]."""

    first: float
    last: float


def ends_of(rows: Iterable[Mapping[str, Any]]) -> dict[str, LogEnds]:
    """Of each source of a test that logs on a clock: seconds from nowhere begin at 0 in every log. Of what is written
    on change the rows and their median step tell no length: where `with_lengths` saw its files, these do."""
    found: dict[str, list[LogEnds]] = defaultdict(list)
    for row in rows:
        if row["start_ns"] is not None and row["step_s"] and row["rows"] and row.get("clock") != "relative":
            first = row["start_ns"] / 1e9
            logged_s = row.get(LASTS_S)
            if logged_s is None:
                logged_s = row["step_s"] * (row["rows"] - 1) + row.get(PAUSED_S, 0.0)
            found[row["source"]].append(LogEnds(first, first + logged_s))
    return {s: LogEnds(min(e.first for e in some), max(e.last for e in some)) for s, some in found.items()}


def with_pauses(rows: Rows, events: Rows) -> dict[str, list[dict[str, Any]]]:
    """The rows, each with its pauses. events: test -> rows of the table `quality_event`."""
    found: dict[str, list[dict[str, Any]]] = {}
    for test, of_test in rows.items():
        gaps = {
            (e["source"], e["stream"], e["from_s"], e["to_s"])
            for e in events.get(test, ())
            if e["flag"] == "gap" and e["from_s"] is not None and e["to_s"] is not None
        }
        found[test] = [
            {**r, PAUSED_S: sum(to - begin for source, stream, begin, to in gaps if _is_of(r, source, stream))}
            for r in of_test
        ]
    return found


def with_lengths(rows: Rows, files: Rows) -> dict[str, list[dict[str, Any]]]:
    """The rows, each with how long its files last. files: test -> rows of the table `file`.

    A clock that was set back goes through some times twice: what follows was joined, and lasts as long as the rows that
    were kept say, where that is longer."""
    found: dict[str, list[dict[str, Any]]] = {}
    for test, of_test in rows.items():
        raws: dict[tuple[str, str], list[RawStream]] = defaultdict(list)
        kept: Counter[tuple[str, str]] = Counter()
        for file in files.get(test, ()):
            of = file["source"], file["stream"]
            if file["layer"] == "raw":
                raws[of].append(RawStream.from_row(file))
            elif file["layer"] == "tidy":
                kept[of] += file["rows"] or 0
        lengths = {of: lasts_s for of, some in raws.items() if (lasts_s := _lasts_s(some)) is not None}
        back = {of for of in lengths if any(r.ordered is False and not r.newest_first for r in raws[of])}
        for r in of_test:
            of = r["source"], r["stream"]
            if of in back and r["step_s"]:
                lengths[of] = max(lengths[of], r["step_s"] * (kept[of] - 1) + r.get(PAUSED_S, 0.0))
        found[test] = [{**r, LASTS_S: lengths.get((r["source"], r["stream"]))} for r in of_test]
    return found


def _lasts_s(raws: list[RawStream]) -> float | None:
    """[s]; None of several files whose times count from nowhere."""
    if len(raws) > 1 and any(r.is_undated for r in raws):
        return None
    spans = [recorded(r) for r in raws]
    return (max(last for _, last in spans) - min(first for first, _ in spans)) / 1e9


def _is_of(row: Mapping[str, Any], source: str, stream: str | None) -> bool:
    return bool(row["source"] == source and row["stream"] == stream)


def run_through(ends: Mapping[str, Mapping[str, LogEnds]]) -> set[str]:
    """The sources with one and the same log in several tests, of which each has a part: it begins there at one time,
    though pauses are known of the part alone. ends: of each test."""
    begins: dict[str, list[float]] = defaultdict(list)
    for of_test in ends.values():
        for source, own in of_test.items():
            begins[source].append(own.first)
    return {source for source, each in begins.items() if len(set(each)) < len(each)}


def pairs(rows: Rows) -> Iterator[tuple[str, str, dict[str, tuple[float, float]]]]:
    """(one source, another, test -> by how much the one begins and ends later [s]); but for logs that run through all
    tests, which end with none of them."""
    ends = {test: ends_of(of_test) for test, of_test in rows.items()}
    sources = sorted({source for of_test in ends.values() for source in of_test})
    sources = [s for s in sources if len({of_test[s] for of_test in ends.values() if s in of_test}) > 1]
    for one, other in combinations(sources, 2):
        yield (
            one,
            other,
            {
                test: (of[one].first - of[other].first, of[one].last - of[other].last)
                for test, of in ends.items()
                if one in of and other in of
            },
        )
