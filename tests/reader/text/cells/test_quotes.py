"""Quotes: those around a cell go, those of its own parts stay."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.plugin import Source
from thermodata.reader.text import delimited
from thermodata.reader.text.cells.values.quotes import clean

TAG = 'ns=3;s="DB"."T01"'


@pytest.mark.parametrize(
    ("cell", "cleaned"),
    [
        (TAG, TAG),
        ('"DB"."T01"', '"DB"."T01"'),
        ('"DB"."T"[3]."x"', '"DB"."T"[3]."x"'),
        ('"ns=3;s=""DB"".""T01"""', TAG),
        (' "T01" ', "T01"),
        ('"T01', "T01"),
        ('T01"', "T01"),
        ('2" probe', '2" probe'),
        ('"2" probe"', '2" probe'),
        ('""', ""),
        ('"', '"'),
    ],
)
def test_quotes_of_the_parts_of_a_name_stay(cell: str, cleaned: str) -> None:
    assert clean(cell) == cleaned


def test_a_node_id_is_a_signals_name_with_both_its_quotes(tmp_path: Path) -> None:
    header = 'time,"' + TAG.replace('"', '""') + '"'
    rows = [f"2026-03-02T08:00:{k:02}Z,{20 + k / 10:.1f}" for k in range(30)]
    (tmp_path / "a.csv").write_text("\n".join([header, *rows, ""]))
    (signal,) = delimited.signals(delimited.open_table(tmp_path / "a.csv", Source()))
    assert signal.name == TAG
