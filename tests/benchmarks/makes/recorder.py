"""MCAP as a recorder of the hall's air writes it: messages of JSON, one each time, with all its signals."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from datetime import datetime
from pathlib import Path

from mcap.writer import Writer

from .bodies import Array

EPOCH = datetime(1970, 1, 1)


def mcap(path: Path, times: Sequence[datetime], data: Mapping[str, Array], topic: str = "air") -> None:
    """times: in UTC, without a zone. data: by signal, shape (n,)."""
    numbers = {signal: {"type": "number"} for signal in data}
    said = json.dumps({"type": "object", "properties": numbers}).encode()
    with path.open("wb") as file:
        log = Writer(file)
        log.start()
        told = log.register_channel(f"/{topic}", "json", log.register_schema(topic, "jsonschema", said))
        for i, t in enumerate(times):
            ns = round((t - EPOCH).total_seconds()) * 10**9
            values = {signal: round(float(x[i]), 3) for signal, x in data.items()}
            log.add_message(told, ns, json.dumps(values).encode(), ns)
        log.finish()
