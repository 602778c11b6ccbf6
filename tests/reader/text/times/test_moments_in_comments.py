"""A moment that somebody wrote into a comment is no time of its row."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited


def times(folder: Path, names: str, every: int, said: str) -> tuple[str, list[float], tuple[str, ...]]:
    """(clock, seconds of the rows, names of the signals) of rows at 60 s, with something in every n-th comment."""
    rows = [f"{60 * k};{20 + k / 100:.2f};{said if k % every == 5 else ''}" for k in range(120)]
    path = folder / "log.csv"
    path.write_text("\n".join([names, *rows, ""]), "utf-8")
    table = delimited.open_table(path, Source())
    told = delimited.describe(table, Source())
    found = [b for b in delimited.blocks(path, table, Source()) if isinstance(b, Block)]
    return told.clock, (np.concatenate([b.t_ns for b in found]) / 1e9).tolist(), tuple(s.name for s in told.signals)


@pytest.mark.parametrize("name", ["Comment", "Kommentar", "Bemerkung", "Poznámka"])
@pytest.mark.parametrize("said", ["08:05", "08:05:00", "2026-03-02 08:05:00", "02.03.2026"])
def test_rows_are_dated_by_the_time_beside_a_comment(tmp_path: Path, name: str, said: str) -> None:
    clock, seconds, signals = times(tmp_path, f"t [s];T_bed [degC];{name}", 30, said)
    assert clock == "relative"
    assert seconds == [60.0 * k for k in range(120)]
    assert signals == ("T_bed [degC]", name)
