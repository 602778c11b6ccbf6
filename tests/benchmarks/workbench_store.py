"""A store of many long tests at 1 Hz, written without raw logs; for benchmarks of what reads it."""

from __future__ import annotations

import json
from datetime import datetime
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from thermodata.store import Store
from thermodata.store.base.connection import insert

START_NS = 1_772_000_000_000_000_000


def make(folder: Path, tests: int, hours: float, channels: int) -> Path:
    """A store with one stream a test; nothing where it is there."""
    path = folder / f"store-{tests}-{hours:g}-{channels}"
    if (path / "catalog.duckdb").exists():
        return path
    store = Store(path, create=True)
    now, n = datetime(2026, 3, 1), int(hours * 3600)
    t_s = np.arange(n, dtype=float)
    names = [f"T_{i:02}" for i in range(channels)]
    rows: dict[str, list[dict[str, object]]] = {"test": [], "channel": [], "file": [], "source": []}
    for k in range(tests):
        rng, test = np.random.default_rng(k), f"t{k:03}"
        columns: dict[str, object] = {
            "t": pa.array(START_NS + (t_s * 1e9).astype("int64")).cast(pa.timestamp("ns")),
            "t_s": t_s,
        }
        for name in names:
            columns[name] = np.round(20 + np.cumsum(rng.normal(0, 0.01, n)), 3)
            columns[name + "__flag"] = np.zeros(n, "uint16")
        pq.write_table(pa.table(columns), path / f"tidy/{test}.parquet", compression="zstd", row_group_size=100_000)
        own = {"campaign": "big", "test": test}
        rows["test"].append(
            {
                **own,
                "kind": "mixed",
                "role": "calibration",
                "start_ns": START_NS,
                "clock": "absolute",
                "conditions": "{}",
                "duration_s": float(n - 1),
            }
        )
        rows["source"].append(
            {
                **own,
                "source": "daq",
                "stream": "daq",
                "reader": "table",
                "clock": "absolute",
                "rows": n,
                "offset_ns": 0,
                "step_s": 1.0,
            }
        )
        rows["file"].append(
            {
                **own,
                "source": "daq",
                "stream": "daq",
                "layer": "tidy",
                "part": "test",
                "key": test,
                "path": f"tidy/{test}.parquet",
                "rows": n,
                "columns": json.dumps({"samples": n * channels, "flags": {}}),
                "added_at": now,
            }
        )
        rows["channel"] += [
            {
                **own,
                "channel": c,
                "source": "daq",
                "stream": "daq",
                "quantity": "temperature",
                "unit": "degC",
                "sign": "+",
                "dtype": "float64",
            }
            for c in names
        ]
    with store.write() as con:
        insert(
            con,
            "campaign",
            [{"campaign": "big", "spec": "{}", "spec_hash": "h", "ingested_at": now, "data_version": "v1"}],
        )
        for table, listed in rows.items():
            insert(con, table, listed)
    return path
