"""A log of a test that ends long before another of it, or begins long after."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from thermodata.schema.words.sentences import with_count
from thermodata.store.ingest.told.ends import ends_of, run_through

LEAST_S = 300.0  # for so long a driver is carried on at its ends without a word
_NAMED = 6


def ends_apart(rows: Mapping[str, Iterable[Mapping[str, Any]]], responses: Collection[str]) -> list[str]:
    """A sentence for each two sources and each end. rows: test -> its rows of the table `source`. responses: the
    sources of displacements, which a log of drivers has to last as long as, but for one that runs through several
    tests and is cut to each of them."""
    found: dict[tuple[str, str, str], list[str]] = {}
    of_tests = {test: ends_of(of_test) for test, of_test in rows.items()}
    measured = set(responses) - run_through(of_tests)
    for test, ends in of_tests.items():
        of = [s for s in ends if s in measured]
        if not of:
            continue
        last, first = max(of, key=lambda s: ends[s].last), min(of, key=lambda s: ends[s].first)
        for source, own in ends.items():
            for by_s, words, other in (
                (ends[last].last - own.last, "ends {} before", last),
                (own.first - ends[first].first, "begins {} after", first),
            ):
                if by_s >= LEAST_S:
                    found.setdefault((source, words, other), []).append(f"{by_s / 60:.3g} min in {test}")
    return [
        f"source '{source}' {words.format('long')} '{other}': {with_count(tests, _NAMED)}; what it alone measured is "
        f"not known there, and a model takes its {'last' if 'ends' in words else 'first'} value for up to half an hour"
        for (source, words, other), tests in found.items()
    ]
