"""A store with tidy files that a test describes in a few lines, made through the store's own write()."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from thermodata.store import Store
from thermodata.store.base.connection import insert

START_NS = 1_772_000_000_000_000_000
NOW = datetime(2026, 3, 1)
UNITS = {"displacement": "um", "temperature": "degC", "rotational_speed": "rpm", "state": "1", "label": "1"}


class Builder:
    """Collects rows and Parquet files; `store()` commits them. columns: channel -> values or (values, flags)."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.rows: dict[str, list[dict[str, Any]]] = {}
        self.start = START_NS

    def add(self, table: str, **row: Any) -> None:
        self.rows.setdefault(table, []).append(row)

    def test(self, campaign: str, test: str, **more: Any) -> None:
        if not any(r["campaign"] == campaign for r in self.rows.get("campaign", [])):
            self.add("campaign", campaign=campaign, spec="{}", spec_hash="h", ingested_at=NOW, data_version="v1")
        self.add(
            "test",
            **{
                "campaign": campaign,
                "test": test,
                "kind": "spindle",
                "role": "calibration",
                "start_ns": self.start,
                "clock": "absolute",
                "conditions": "{}",
                **more,
            },
        )

    def channel(
        self, campaign: str, test: str, channel: str, quantity: str = "displacement", source: str = "daq", **more: Any
    ) -> None:
        self.add(
            "channel",
            **{
                "campaign": campaign,
                "test": test,
                "channel": channel,
                "source": source,
                "stream": source,
                "quantity": quantity,
                "unit": UNITS[quantity],
                "sign": "+",
                "dtype": "str" if quantity == "label" else "float64",
                **more,
            },
        )

    def tidy(
        self,
        campaign: str,
        test: str,
        t_s: Any,
        columns: Mapping[str, Any],
        *,
        source: str = "daq",
        stream: str | None = None,
        part: str = "test",
        name: str | None = None,
    ) -> Path:
        times = np.asarray(t_s, dtype=float)
        data: dict[str, Any] = {
            "t": pa.array(self.start + np.round(times * 1e9).astype("int64")).cast(pa.timestamp("ns")),
            "t_s": times,
        }
        for channel, given in columns.items():
            values, flags = given if isinstance(given, tuple) else (given, np.zeros(times.size))
            data[channel] = pa.array(values)
            data[channel + "__flag"] = np.asarray(flags).astype("uint16")
        path = f"tidy/{name or len(self.rows.get('file', []))}.parquet"
        (self.folder / "tidy").mkdir(parents=True, exist_ok=True)
        pq.write_table(pa.table(data), self.folder / path)
        self.add(
            "file",
            campaign=campaign,
            test=test,
            source=source,
            stream=stream or source,
            layer="tidy",
            part=part,
            key=path,
            path=path,
            rows=times.size,
            added_at=NOW,
        )
        if not any(
            (r["campaign"], r["test"], r["source"], r["stream"]) == (campaign, test, source, stream or source)
            for r in self.rows.get("source", [])
        ):
            self.add(
                "source",
                campaign=campaign,
                test=test,
                source=source,
                stream=stream or source,
                reader="table",
                clock="absolute",
                rows=times.size,
                offset_ns=0,
                step_s=float(np.median(np.diff(times))) if times.size > 1 else None,
            )
        return self.folder / path

    def prediction(self, campaign: str, test: str, model: str, response: str, data: Mapping[str, Any]) -> None:
        path = f"model/{len(self.rows.get('prediction', []))}.parquet"
        (self.folder / "model").mkdir(parents=True, exist_ok=True)
        pq.write_table(pa.table(dict(data)), self.folder / path)
        self.add(
            "prediction", campaign=campaign, test=test, model=model, response=response, path=path, rows=len(data["t_s"])
        )

    def model(self, model: str, name: str, parent: str | None = None, **more: Any) -> None:
        self.add(
            "model",
            **{
                "model": model,
                "name": name,
                "parent": parent,
                "campaigns": ["c"],
                "response": "dZ",
                "spec": "{}",
                "data_version": "v1",
                "stale": False,
                "created_at": NOW,
                "result": "{}",
                **more,
            },
        )

    def finding(self, model: str, kind: str, payload: Mapping[str, Any], **more: Any) -> None:
        self.add(
            "finding",
            **{
                "campaign": "",
                "test": "",
                "model": model,
                "kind": kind,
                "rank": None,
                "payload": json.dumps(payload),
                "created_at": NOW,
                **more,
            },
        )

    def store(self) -> Store:
        store = Store(self.folder, create=True)
        with store.write() as con:
            for table, rows in self.rows.items():
                names = {name for row in rows for name in row}
                insert(con, table, [{name: row.get(name) for name in names} for row in rows])
        self.rows = {}
        return store


@pytest.fixture
def build(tmp_path: Path) -> Callable[..., Builder]:
    """build(folder="store") -> Builder."""
    return lambda folder="store": Builder(tmp_path / folder)


@pytest.fixture(scope="module")
def build_once(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Builder]:
    """As `build`, for stores that the tests of a module only read."""
    return lambda folder="store": Builder(tmp_path_factory.mktemp("once") / folder)


@pytest.fixture(scope="module")
def empty_store(tmp_path_factory: pytest.TempPathFactory) -> Store:
    return Store(tmp_path_factory.mktemp("empty") / "store", create=True)
