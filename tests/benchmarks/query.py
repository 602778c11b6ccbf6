"""Five channels of one test at 10 s as Arrow, from a store of 100 tests of 12 h at 1 Hz with 8 channels.

    uv run python tests/benchmarks/query.py [--tests 100] [--runs 20]

first: the first time in the process, in the first row with the opening of the store; then medians of the runs, each on
another test. The peer is told the test's TDMS file, reads it with npTDMS and takes means of 10 s with pandas: no
calibration, no flags, no clocks of other sources.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

from measure import PROGRAM, machine, run, table

HOURS, CHANNELS, WANTED = 12, 8, 5


def generate(folder: Path, tests: int) -> None:
    """raw/tNNN.tdms and campaign.yaml."""
    import numpy as np
    from nptdms import ChannelObject, TdmsWriter

    (folder / "raw").mkdir(parents=True)
    rng = np.random.default_rng(0)
    n = HOURS * 3600
    noise = 0.01 * rng.standard_normal((CHANNELS, n))
    for test in range(tests):
        start = np.datetime64("2026-03-02T06:00:00") + np.timedelta64(test, "D")
        with TdmsWriter(str(folder / "raw" / f"t{test:03d}.tdms")) as writer:
            writer.write_segment(
                [
                    ChannelObject(
                        "Log",
                        f"S{i}",
                        20 + np.sin(np.arange(n) / 3600 + test + i) + noise[i],
                        {"wf_start_time": start, "wf_increment": 1.0, "wf_start_offset": 0.0, "unit_string": "degC"},
                    )
                    for i in range(CHANNELS)
                ]
            )
    lines = [
        "schema: thermodata/campaign/1",
        "id: many",
        "machine: {id: m}",
        "sources: {daq: {reader: crio, files: 'raw/{test}.tdms'}}",
        "channels:",
    ]
    lines += [f"  T{i}: {{source: daq, signal: Log/S{i}, quantity: temperature, unit: degC}}" for i in range(CHANNELS)]
    lines += ["tests:", *(f"  - {{id: t{test:03d}, kind: other, role: none}}" for test in range(tests))]
    (folder / "campaign.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def peer(path: Path) -> Any:
    """The same answer from the raw file."""
    import pandas as pd
    from nptdms import TdmsFile

    with TdmsFile.open(path) as file:
        columns = {
            f"T{i}": file["Log"][f"S{i}"].as_dataframe(time_index=True, absolute_time=True).iloc[:, 0]
            for i in range(WANTED)
        }
    return pd.DataFrame(columns).resample("10s").mean()


def timed(ask: Callable[[str], Any], tests: list[str]) -> tuple[float, float, int]:
    """The first and the median of the others [ms], and the rows of the last answer."""
    times, rows = [], 0
    for test in tests:
        begin = time.perf_counter()
        found = ask(test)
        times.append(1000 * (time.perf_counter() - begin))
        rows = len(found)
    return times[0], median(times[1:]), rows


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--tests", type=int, default=100)
    arguments.add_argument("--runs", type=int, default=20)
    given = arguments.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        generate(folder, given.tests)
        ingest = run([PROGRAM, "--store", folder / "store", "ingest", folder / "campaign.yaml", "--json"])
        print(
            f"{machine()}; {given.tests} tests, {ingest.answer['samples'] / 1e6:.1f} million samples, "
            f"ingested in {ingest.seconds:.0f} s",
            flush=True,
        )

        import thermodata

        names = ", ".join(f"T{i}" for i in range(WANTED))
        view = thermodata.open(folder / "store")
        tests = [f"t{(7 * i) % given.tests:03d}" for i in range(given.runs + 1)]
        asks: dict[str, Callable[[str], Any]] = {
            "binned(campaign, test, '10 s'), five channels": lambda test: view.sql(
                f"select t_s, {names} from binned('many', ?, '10 s') order by t_s", [test]
            ).to_arrow_table(),
            "aligned(campaign, test, '10 s'), five channels": lambda test: view.sql(
                f"select t_s, {names} from aligned('many', ?, '10 s') order by t_s", [test]
            ).to_arrow_table(),
            "signal(campaign, test, channel), every sample of one": lambda test: view.sql(
                "select t_s, value from signal('many', ?, 'T3')", [test]
            ).to_arrow_table(),
            "mean of a channel in every test": lambda test: view.sql(
                "select test, avg(value) from sample where channel = 'T3' group by test"
            ).to_arrow_table(),
            "npTDMS + pandas from the test's own file, five channels": lambda test: peer(
                folder / "raw" / f"{test}.tdms"
            ),
        }
        rows: list[list[str]] = []
        for what, ask in asks.items():
            first, middle, count = timed(ask, tests)
            reference = float(rows[0][2]) if rows else middle
            rows.append([what, f"{first:.0f}", f"{middle:.1f}", f"{middle / reference:.2f}", str(count)])
    print(table(["query", "first [ms]", "median [ms]", "ratio", "rows"], rows))


if __name__ == "__main__":
    main()
