"""Files of a test with nothing in a stream, or with texts that XML cannot say."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.export.content import Content, Stream
from thermodata.export.mat import write_mat
from thermodata.export.mdf import write_mdf
from thermodata.export.xlsx import write_xlsx
from thermodata.plugin import Source
from thermodata.testing.reader import load

Write = Callable[[Content, Path], None]
WRITERS: dict[str, Write] = {"mat": write_mat, "mf4": write_mdf, "xlsx": write_xlsx}


def stream(name: str, rows: int) -> Stream:
    values = {"dZ": np.arange(float(rows)), "mode": np.array(["é"] * rows, object)}
    return Stream(name, np.arange(float(rows)), values, {})


@pytest.mark.parametrize("suffix", WRITERS)
def test_control_characters_and_empty_streams_do_not_end_an_export(tmp_path: Path, suffix: str) -> None:
    about = {"campaign": "c", "test": "t", "notes": "first\x01 of <the> day & \x1bnight"}
    channels = {"dZ": {"unit": "um", "notes": "glued\x02"}}
    content = Content("c", "t", about, {}, {}, channels, None, "logged", (stream("a", 3), stream("b", 0)))
    path = tmp_path / f"x.{suffix}"
    WRITERS[suffix](content, path)
    read = load(Reader(), path, Source(timezone="UTC"))
    (values,) = (v.tolist() for (_, name), v in read.values.items() if name.endswith("dZ"))
    assert values == [0.0, 1.0, 2.0]
