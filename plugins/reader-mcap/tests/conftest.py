"""MCAP files made by the mcap package's writer, and all that a reader gives of one."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import CompressionType, Writer
from thermodata_reader_mcap import Reader

from thermodata.plugin import Loss, Recording, Source
from thermodata.reader.contract.guard import described, guarded

T0 = 1_772_434_800_000_000_000
STEP = 10_000_000
Message = tuple[str, int, Any]


def _write(
    path: Path,
    messages: Iterable[Message],
    *,
    compression: CompressionType = CompressionType.ZSTD,
    schema: Mapping[str, Any] | tuple[str, str, bytes] | None = None,
    publish: Callable[[int], int] = lambda t: t,
    chunk: int = 4096,
    encoding: str = "json",
    **options: Any,
) -> Path:
    with path.open("wb") as file:
        writer = Writer(file, compression=compression, chunk_size=chunk, **options)
        writer.start()
        number = 0
        if isinstance(schema, tuple):
            number = writer.register_schema(*schema)
        elif schema is not None:
            number = writer.register_schema("s", "jsonschema", json.dumps(schema).encode())
        channels: dict[str, int] = {}
        for topic, t_ns, message in messages:
            if topic not in channels:
                channels[topic] = writer.register_channel(topic, encoding, number)
            data = message if isinstance(message, bytes) else json.dumps(message).encode()
            writer.add_message(channels[topic], t_ns, data, publish(t_ns))
        writer.finish()
    return path


def _read(
    path: Path,
    source: Source = Source(),  # noqa: B008
) -> tuple[
    Recording,
    dict[str, np.ndarray],
    dict[str, list[Any]],
    dict[str, list[int]],
    list[Loss],
]:
    recording = described(Reader(), path, source)
    times: dict[str, list[np.ndarray]] = {}
    values: dict[str, list[Any]] = {s.name: [] for s in recording.signals}
    flags: dict[str, list[int]] = {s.name: [] for s in recording.signals}
    losses = []
    for item in guarded(Reader(), path, source, recording):
        if isinstance(item, Loss):
            losses.append(item)
            continue
        times.setdefault(item.stream, []).append(item.t_ns)
        for name, part in item.values.items():
            values[name] += part.tolist()
            flags[name] += (item.flags or {}).get(name, np.zeros(part.size, np.uint16)).tolist()
    return recording, {k: np.concatenate(v) for k, v in times.items()}, values, flags, losses


def _axis(n: int) -> list[Message]:
    return [
        (
            "/axis",
            T0 + k * STEP,
            {"pos": {"x": k / 8, "z": -k}, "t": [20 + k / 4, 21.5], "on": k % 2 == 0, "prog": f"MPF{k // 100}"},
        )
        for k in range(n)
    ]


@pytest.fixture(scope="session")
def write() -> Any:
    """write(path, [(topic, log time, message)], ...): a file; messages are bytes, or become JSON."""
    return _write


@pytest.fixture(scope="session")
def read() -> Any:
    """read(path, source): recording, times by stream, values and flags by signal, losses; all through the guard."""
    return _read


@pytest.fixture(scope="session")
def axis() -> Any:
    """axis(n): messages of one topic with nested fields, arrays, numbers, booleans and text."""
    return _axis
