"""Columns of statistics that repeat have the names of their channels, which stand in a row further up."""

from __future__ import annotations

import pytest

from thermodata.reader.text.names.header_rows import names_and_units


@pytest.mark.parametrize(
    ("channels", "statistics", "named"),
    [
        ("Ch;a;;b;;c;", "MIN;AVG;STD;MAX;MIN;MAX", "a/MIN;AVG;STD;b/MAX;c/MIN;c/MAX"),
        ("Ch;a;;b;;", "MIN;MAX;AVG;MIN;MAX", "a/MIN;a/MAX;AVG;b/MIN;b/MAX"),
        ("Ch;a;;b;", "MIN;MAX;MIN;MAX", "a/MIN;a/MAX;b/MIN;b/MAX"),
        ("Ch;a;b;c;d", "MIN;MAX;MIN;MAX", "a/MIN;b/MAX;c/MIN;d/MAX"),
        (";;;b;", "MIN;MAX;MIN;MAX", "MIN;MAX;MIN;MAX"),
        ("Logger X;;;b;", "MIN;MAX;MIN;MAX", "MIN;MAX;MIN;MAX"),
        ("Ch;a;;;", "MIN;MAX;MIN;MAX", "MIN;MAX;MIN;MAX"),
    ],
)
def test_a_channel_is_carried_over_all_of_its_columns(channels: str, statistics: str, named: str) -> None:
    rows = [text.split(";") for text in (channels, "x" + ";" * statistics.count(";") + ";", f"Time;{statistics}")]
    names, _, _ = names_and_units(rows, len(rows[-1]), None)
    assert names == ["Time", *named.split(";")]
