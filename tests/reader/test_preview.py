"""The preview of a file."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from thermodata.plugin import Block, Head, Loss, Recording, Signal, Source
from thermodata.reader.finding.preview import Until, preview

S = 1_000_000_000
START = np.datetime64("2026-03-01T08:00:00", "ns").astype(np.int64).item()


class Fake:
    """10 rows of 1 s, a hole of 60 s, a repeated row and a step back, in blocks of 4."""

    name = "fake"

    def sniff(self, head: Head) -> str | None:
        return "always"

    def describe(self, path: Path, source: Source) -> Recording:
        return Recording((Signal("T", "s", "degC"),), "absolute", START, False, ("a note",))

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        t = START + S * np.array([0, 1, 2, 3, 63, 64, 64, 65, 60, 66])
        v = np.array([np.nan, *range(1, 10)], float)
        for i in range(0, 10, 4):
            yield Block("s", t[i : i + 4], {"T": v[i : i + 4]})
        yield Loss("byte 9", START + 66 * S, None, 0.25, "cut")


def test_preview_says_start_rate_gaps_and_first_rows(tmp_path: Path) -> None:
    path = tmp_path / "x.log"
    path.write_bytes(b"x")
    found = preview(path, reader=Fake())
    stream = found["streams"][0]
    assert found["start"] == "2026-03-01T08:00:00Z"
    assert (stream["rows"], stream["step_s"], stream["rate_hz"]) == (10, 1.0, 1.0)
    assert (stream["gaps"], stream["largest_step_s"], stream["backward"], stream["repeated"]) == (2, 60.0, 1, 1)
    assert stream["first_rows"][0] == {"t": "2026-03-01T08:00:00Z", "T": None}
    assert len(stream["first_rows"]) == 5
    assert found["losses"][0]["fraction"] == 0.25
    json.dumps(found, allow_nan=False)


def test_a_small_file_is_read_whole_however_long_it_takes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "x.log"
    path.write_bytes(b"x")
    assert preview(path, reader=Fake(), until=Until(most_s=0.0))["whole"]
    monkeypatch.setattr("thermodata.reader.finding.preview._SMALL", 0)
    assert not preview(path, reader=Fake(), until=Until(most_s=0.0))["whole"]


def test_preview_of_a_large_file_reads_a_part_and_says_so(tmp_path: Path) -> None:
    path = tmp_path / "x.log"
    path.write_bytes(b"x")
    seen: list[int] = []
    part = preview(path, reader=Fake(), until=Until(1, most_rows=6), watch=lambda block: seen.append(block.t_ns.size))
    assert (part["rows_read"], part["whole"], seen) == (8, False, [4, 4])
    assert len(part["streams"][0]["first_rows"]) == 1
    whole = preview(path, reader=Fake())
    assert (whole["rows_read"], whole["whole"]) == (10, True)
