"""What the recorder of the hall writes: MCAP with JSON messages of the air stations, every 10 s."""

from __future__ import annotations

import json
from pathlib import Path

from thermodata.errors import UsageError
from thermodata.virtual.gantry.logs.logbook import Logbook
from thermodata.virtual.gantry.plan import STEP_S
from thermodata.virtual.gantry.world import Run, World

TOPIC = "/hall/air"


def write_mcap(path: Path, world: World, run: Run, book: Logbook) -> None:
    """One test. The recorder's clock is off by what the campaign file declares."""
    try:
        from mcap.writer import Writer
    except ImportError as error:
        raise UsageError(
            "an MCAP log can't be written without the package 'mcap'",
            hint="install thermodata-reader-mcap, which brings it",
        ) from error
    sensors = [s for s in world.sensors if s.source == "rec"]
    fields = [book.names[s.name].rpartition(".")[2] for s in sensors]
    rows = zip(*(run.readings[s.name].tolist() for s in sensors), strict=True)
    start_ns = round((run.start_unix_s - book.rec_offset_s) * 1e9)
    schema = {"type": "object", "properties": {f: {"type": "number"} for f in fields}}
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start(profile="", library="hall recorder")
        number = writer.register_schema(name="hall.Air", encoding="jsonschema", data=json.dumps(schema).encode())
        channel = writer.register_channel(topic=TOPIC, message_encoding="json", schema_id=number)
        for k, row in enumerate(rows):
            t = start_ns + round(k * STEP_S * 1e9)
            message = json.dumps({f: round(x, 4) for f, x in zip(fields, row, strict=True)})
            writer.add_message(
                channel_id=channel, log_time=t + 2_000_000, publish_time=t, sequence=k, data=message.encode()
            )
        writer.finish()
