"""A tiny reader and campaigns for the store's tests: .npz files, one array a signal."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Loss, Recording, Signal, Source

START_NS = 1_770_000_000_000_000_000
UNITS = {"Z": "V", "T1": "degC", "T2": "degC", "n": "1/min", "door": None, "msg": None, "pos": "mm"}


class NpzReader:
    """Reads what `write_log` writes. A file that ends early is read as far as it goes."""

    name = "npz"
    version = "1"
    reads = 0

    def sniff(self, head: Head) -> str | None:
        return "zip" if head.start.startswith(b"PK") else None

    def _load(self, path: Path) -> dict[str, Any]:
        try:
            with np.load(path, allow_pickle=False) as data:
                return dict(data)
        except Exception as error:
            raise FormatError("not an npz file", where=path.name, got=str(error)) from error

    def describe(self, path: Path, source: Source) -> Recording:
        data = self._load(path)
        signals = []
        for key, values in data.items():
            if key.startswith("_"):
                continue
            stream, name = key.split(":")
            if name != "t_ns":
                kind = "str" if values.dtype.kind == "U" else str(values.dtype)
                signals.append(Signal(name, stream, UNITS.get(name.split("/")[-1]), kind))
        clock = str(data.get("_clock", "absolute"))
        if clock == "relative":
            start = int(data["_start_ns"]) if "_start_ns" in data else None
            return Recording(tuple(signals), "relative", start, complete=True)
        first = min(int(v[0]) for k, v in data.items() if k.endswith(":t_ns"))
        return Recording(tuple(signals), "absolute", first, complete=True)

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        type(self).reads += 1
        data = self._load(path)
        flagged = str(data.get("_flagged", ""))
        for stream in dict.fromkeys(k.split(":")[0] for k in data if not k.startswith("_")):
            t = data[f"{stream}:t_ns"]
            names = [k.split(":")[1] for k in data if k.startswith(f"{stream}:") and not k.endswith(":t_ns")]
            for a in range(0, len(t), 500):
                values = {n: data[f"{stream}:{n}"][a : a + 500] for n in names}
                values = {n: v.astype(object) if v.dtype.kind == "U" else v for n, v in values.items()}
                flags = {flagged: np.full(len(t[a : a + 500]), 4, np.uint16)} if flagged in names and a >= 500 else None
                yield Block(stream, t[a : a + 500], values, flags)
        if "_lost" in data:
            yield Loss("at the end", reason=str(data["_lost"]), fraction=0.1)


def write_log(path: Path, streams: Mapping[str, Mapping[str, Any]], **meta: str) -> Path:
    """A log of streams {name: {t_ns: ..., signal: ...}}."""
    path.parent.mkdir(parents=True, exist_ok=True)
    arrays = {f"{s}:{k}": np.asarray(v) for s, cols in streams.items() for k, v in cols.items()}
    np.savez(path, **arrays, **{f"_{k}": np.array(v) for k, v in meta.items()})
    return path


def times(n: int, step_s: float = 1.0, start_s: float = 0.0, start_ns: int = START_NS) -> Any:
    return start_ns + np.rint((start_s + np.arange(n) * step_s) * 1e9).astype(np.int64)


def daq(n: int = 1200, seed: int = 0, start_s: float = 0.0, step_s: float = 1.0) -> dict[str, dict[str, Any]]:
    rng = np.random.default_rng(seed)
    s = start_s + np.arange(n) * step_s
    return {
        "main": {
            "t_ns": times(n, step_s, start_s),
            "Z": 5 + 0.1 * np.sin(s / 300) + 1e-4 * rng.standard_normal(n),
            "T1": 20 + s / 600 + 0.01 * rng.standard_normal(n),
            "T2": (200 + s // 60).astype(np.int16),
        }
    }


CAMPAIGN = """
schema: thermodata/campaign/1
id: shop
machine: {id: "138", spindle: SP1}
sources:
  daq: {reader: npz, files: "raw/{test}_*.npz"}
  nc: {reader: npz, files: "raw/{test}.nc.npz"}
channels:
  dZ: {source: daq, signal: Z, quantity: displacement, unit: V, axis: Z, at: tcp, calibration: lvdt}
  T_a: {source: daq, signal: T1, quantity: temperature, at: spindle}
  T_b: {source: daq, signal: T2, quantity: temperature, at: bed}
  speed: {source: nc, signal: n, quantity: rotational_speed, at: spindle}
  message: {source: nc, signal: msg, quantity: label}
calibrations:
  lvdt: {kind: scale, axis: Z, gain: 10 um/V, facing: -Z, increases_with: gap}
tests:
  - {id: one, kind: spindle, role: calibration, conditions: {speed: 9000 rpm}}
  - {id: two, kind: spindle, role: verification, phases: {heating: [0 s, 600 s]}}
"""


def write_campaign(folder: Path, text: str = CAMPAIGN, *, logs: bool = True) -> Path:
    """The campaign file, and the logs of its two tests."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "campaign.yaml"
    path.write_text(textwrap.dedent(text), encoding="utf-8")
    if logs:
        for i, test in enumerate(("one", "two")):
            write_log(folder / f"raw/{test}_a.npz", daq(seed=i))
            n = 130
            write_log(
                folder / f"raw/{test}.nc.npz",
                {
                    "nc": {
                        "t_ns": times(n, 10.0),
                        "n": np.where(np.arange(n) < 60, 9000.0, 0.0),
                        "msg": np.where(np.arange(n) < 60, "RUN", "STOP"),
                    }
                },
            )
    return path


def install() -> None:
    """Lets the store find the reader, as an entry point would."""
    from thermodata.store.ingest.reading import campaign_files

    campaign_files.find_reader = lambda name: NpzReader()  # type: ignore[assignment]
