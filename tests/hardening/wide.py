"""A file of 100,000 channels and a campaign of 10 of them: time and peak memory of the ingest.

.venv/bin/python tests/hardening/wide.py [--channels 100000] [--rows 100]
"""

from __future__ import annotations

import argparse
import resource
import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from thermodata.plugin import Block, Head, Recording, Signal, Source
from thermodata.store import Store
from thermodata.store.ingest.reading import campaign_files
from thermodata.store.ingest.run import ingest


class WideReader:
    """So many channels, so many rows, in blocks of 10 rows."""

    name, version = "wide", "1"

    def __init__(self, channels: int, rows: int) -> None:
        self.names, self.rows = [f"group {i // 1000}/channel {i}" for i in range(channels)], rows

    def sniff(self, head: Head) -> str | None:
        return None

    def describe(self, path: Path, source: Source) -> Recording:
        return Recording(tuple(Signal(n, "main", "degC") for n in self.names), "absolute", 0)

    def blocks(self, path: Path, source: Source) -> Iterator[Block]:
        for start in range(0, self.rows, 10):
            values = np.arange(start, min(start + 10, self.rows), dtype=np.float64)
            yield Block("main", (values * 1e9).astype(np.int64), {n: values + i for i, n in enumerate(self.names)})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--channels", type=int, default=100_000)
    parser.add_argument("--rows", type=int, default=100)
    given = parser.parse_args()
    reader = WideReader(given.channels, given.rows)
    campaign_files.find_reader = lambda name: reader  # type: ignore[assignment]
    place = Path(tempfile.mkdtemp(prefix="wide-"))
    (place / "x.dat").write_bytes(b"x")
    step = given.channels // 10
    (place / "campaign.yaml").write_text(
        "schema: thermodata/campaign/1\nid: wide\nsources: {s: {reader: wide, files: x.dat}}\ntests: [{id: one}]\n"
        "channels:\n"
        + "".join(
            f"  c{k}: {{source: s, signal: {reader.names[k * step]}, quantity: temperature}}\n" for k in range(10)
        )
    )
    begun = time.monotonic()
    summary = ingest(Store(place / "store", create=True), place / "campaign.yaml")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"{given.channels} channels x {given.rows} rows: {summary.samples} samples of 10 channels, losses "
        f"{len(summary.losses)}, {time.monotonic() - begun:.1f} s, peak {peak:.0f} MiB"
    )
    shutil.rmtree(place)


if __name__ == "__main__":
    main()
