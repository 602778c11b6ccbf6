"""A log of a test that ends long before another of it, or begins long after."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from thermodata.schema.words.durations import how_long
from thermodata.schema.words.sentences import with_count
from thermodata.store.ingest.told.clocks.ends import ends_of, run_through

LEAST_S = 300.0  # for so long a driver is carried on at its ends without a word
_NAMED = 6
_OTHER_DAYS_S = 7 * 86400.0  # what runs so far from the test has a wrong clock, which is told with what it is off by


def ends_apart(rows: Mapping[str, Iterable[Mapping[str, Any]]], responses: Collection[str]) -> list[str]:
    """A sentence for each two sources and each end. rows: test -> its rows of the table `source`. responses: the
    sources of displacements, which a log of drivers has to last as long as. A log that runs through several tests is
    cut to each of them: of neither kind is its end known from its rows, for it may pause between them."""
    found: dict[tuple[str, str, str], list[str]] = {}
    of_tests = {test: ends_of(of_test) for test, of_test in rows.items()}
    through = run_through(of_tests)
    for test, every in of_tests.items():
        ends = {source: own for source, own in every.items() if source not in through}
        of = [s for s in ends if s in responses]
        if not of:
            continue
        last, first = max(of, key=lambda s: ends[s].last), min(of, key=lambda s: ends[s].first)
        for source, own in ends.items():
            if max(ends[first].first - own.last, own.first - ends[last].last) > _OTHER_DAYS_S:
                continue
            for by_s, words, other in (
                (ends[last].last - own.last, "ends {} before", last),
                (own.first - ends[first].first, "begins {} after", first),
            ):
                if by_s >= LEAST_S:
                    found.setdefault((source, words, other), []).append(f"{how_long(by_s)} in {test}")
    return [
        f"source '{source}' {words.format('long')} '{other}': {with_count(tests, _NAMED)}; what it alone measured is "
        f"not known there, and a model takes its {'last' if 'ends' in words else 'first'} value for up to half an hour"
        for (source, words, other), tests in found.items()
    ]
