"""Random TDMS files against npTDMS, the library of reference."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from nptdms import TdmsFile
from thermodata_reader_crio import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import load

TYPES = st.sampled_from(["int16", "int32", "uint8", "float32", "float64"])
NAMES = st.sampled_from(["a", "b/c", "d'e", "ložisko 1", "温度"])


def file_of(draw: Any, make: Callable[[str], Any]) -> bytes:
    """Segments of some channels, contiguous or interleaved, in either byte order; indexes given anew, repeated or
    absent; several chunks a segment; the last one cut short or not."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    types = {name: draw(TYPES) for name in draw(st.lists(NAMES, min_size=1, max_size=4, unique=True))}
    content, known, active = b"", {}, {}  # known: channel -> values a chunk
    for number in range(draw(st.integers(1, 5))):
        b = make(draw(st.sampled_from("<>")))
        interleaved, new = draw(st.booleans()), number == 0 or draw(st.booleans())
        members = draw(st.lists(st.sampled_from(sorted(types)), min_size=1, max_size=len(types), unique=True))
        n, objects = draw(st.integers(1, 6)), []
        active = {} if new else dict(active)
        for name in members:
            again = name in known and draw(st.booleans())
            known[name] = known[name] if again else n
            active[name] = known[name]
            path = name.replace("'", "''")
            objects.append(b.channel("g", path, types[name], known[name], index=b.pack("I", 0) if again else None))
        interleaved = interleaved and len(set(active.values())) == 1
        width = sum(k * np.dtype(types[name]).itemsize for name, k in active.items())
        raw = rng.bytes(width * draw(st.integers(1, 3)))
        content += b.segment(objects, raw, interleaved=interleaved, new_list=new)
    return content


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data(), st.integers(1, 7))
def test_random_files_give_what_nptdms_gives(tdms_in: Callable[[str], Any], data_: st.DataObject, rows: int) -> None:
    content = file_of(data_.draw, tdms_in)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "x.tdms"
        path.write_bytes(content)
        data = load(Reader(), path, Source(options={"block_rows": rows}))
        peer = {channel.path: channel[:] for group in TdmsFile.read(path).groups() for channel in group.channels()}
    ours = {name: values for (_, name), values in data.values.items()}
    assert data.losses == ()
    assert len(ours) == len(peer)
    for path_, values in peer.items():
        name = path_.removeprefix("/'g'/'")[:-1].replace("''", "'")
        assert ours[f"g/{name}"].dtype == values.dtype.newbyteorder("=")
        np.testing.assert_array_equal(ours[f"g/{name}"], values)
