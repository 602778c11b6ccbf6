"""A test as an MDF 4.1 file: a channel group a stream, for CANape, DIAdem, asammdf and their like."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import UsageError
from thermodata.export.content import Content, Stream
from thermodata.export.mat import flag_bits
from thermodata.export.xlsx import in_xml
from thermodata.schema.agreed.exported import SIGN
from thermodata.schema.flag import INVALID

INSTALL = "pip install 'thermodata-reader-table[mdf]'"


def write_mdf(content: Content, path: Path) -> None:
    """Samples that do not count are marked invalid; flags that are set stand in a channel `<name>.flag` beside theirs.
    UsageError where asammdf is not installed."""
    try:
        import asammdf
    except ImportError:
        raise UsageError("MDF needs asammdf, which is not installed", hint=INSTALL) from None
    library: Any = asammdf
    mdf = library.MDF(version="4.10")
    try:
        header = mdf.header
        # exact to the nanosecond, in UTC; 0 says that no clock was absolute
        header.abs_time, header.tz_offset, header.daylight_save_time = content.start_ns or 0, 0, 0
        header.time_flags = 2
        header.comment = _comment(content)  # first: it clears what is set below
        header.project, header.subject = content.campaign, content.test
        for stream in content.streams:
            mdf.append(_signals(library.Signal, content, stream), acq_name=stream.name)
        mdf.save(path, overwrite=True, compression=2)
    finally:
        mdf.close()


def _comment(content: Content) -> str:
    lines = [f"{k}: {v}" for k, v in content.about.items()]
    lines += [f"condition {k}: {v}" for k, v in content.written.items()]
    return in_xml("\n".join([*lines, f"flags: {flag_bits()}"]))


def _signals(make: Callable[..., Any], content: Content, stream: Stream) -> list[Any]:
    found: list[Any] = []
    for name, values in stream.values.items():
        known = content.channels.get(name, {})
        own = {SIGN: known["sign"]} if "sign" in known else {}  # first, where a reader finds it and no note can say it
        about = in_xml(", ".join(f"{k}: {v}" for k, v in {**own, **known}.items()))
        if values.dtype == object:
            texts = np.array([str(v).encode() for v in values], dtype=None if len(values) else "S1")
            found.append(make(texts, stream.t_s, name=name, comment=about, encoding="utf-8"))
            continue
        bits = stream.flags.get(name)
        invalid = np.isnan(values)
        if bits is not None:
            invalid |= (bits & int(INVALID)) != 0
        more: dict[str, Any] = {"invalidation_bits": invalid} if invalid.any() else {}
        found.append(make(values, stream.t_s, name=name, unit=content.unit(name), comment=about, **more))
        if bits is not None:
            found.append(make(bits, stream.t_s, name=f"{name}.flag", comment=flag_bits()))
    return found
