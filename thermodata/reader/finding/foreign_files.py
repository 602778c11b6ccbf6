"""Files of measured values that no reader takes, known by their first bytes: what they are, and the one line that makes
a CSV or a Parquet file of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import PurePath

from thermodata.plugin import Head
from thermodata.reader.text import decode_head
from thermodata.reader.text.rows.fixed_width import by_width, fixed_width

_MOST_NULS = 0.2  # of the bytes of a text that was damaged


@dataclass(frozen=True, slots=True)
class _Kind:
    """magic: first bytes; what: such a file is; do: what to do, with {name} and {stem} of the file."""

    magic: bytes
    what: str
    do: str


_BY_ARROW = (
    'make a Parquet file of it: python -c "import pyarrow.{of} as f, pyarrow.parquet as p; '
    "p.write_table(f.read_table('{{name}}'), '{{stem}}.parquet')\""
)
_KINDS = (
    _Kind(
        b"SQLite format 3",
        "an SQLite database",
        'export its table as CSV: sqlite3 -header -csv {name} "select * from TABLE" > {stem}.csv, where sqlite3 {name} '
        ".tables names the tables",
    ),
    _Kind(
        b"\x89HDF\r\n",
        "HDF5, and no MAT file",
        'make a Parquet file of its data sets: python -c "import h5py, pyarrow, pyarrow.parquet as p; '
        "f = h5py.File('{name}'); p.write_table(pyarrow.table({{k: f[k][:] for k in ['TIME', 'SIGNAL']}}), "
        "'{stem}.parquet')\", where python -c \"import h5py; h5py.File('{name}').visititems(print)\" names the data "
        "sets; of one that pandas wrote: pandas.read_hdf('{name}').to_parquet('{stem}.parquet')",
    ),
    *(_Kind(magic, "Feather (Arrow)", _BY_ARROW.format(of="feather")) for magic in (b"ARROW1", b"FEA1")),
    _Kind(b"ORC", "ORC", _BY_ARROW.format(of="orc")),
    _Kind(
        b"\x93NUMPY",
        "an array of NumPy",
        "name its columns in a CSV: python -c \"import numpy; numpy.savetxt('{stem}.csv', numpy.load('{name}'), "
        "delimiter=',', header='time [s],T_1 [degC]', comments='')\", with the names and units that are right",
    ),
    _Kind(b"Obj\x01", "Avro", "export it as CSV or Parquet from what wrote it"),
)


def foreign_file(start: Head) -> str | None:
    """What such a file is, and what to do; None for all others."""
    found = next((k for k in _KINDS if start.start.startswith(k.magic)), None)
    if found is not None:
        name = start.name
        return f"{found.what}: " + found.do.format(name=name, stem=PurePath(name).stem)
    for what in _OTHERWISE:
        if (said := what(start)) is not None:
            return said
    return None


def _text_with_nuls(start: Head) -> str | None:
    """A text in which bytes are zero: a disk or a line failed while it was written."""
    data = start.start.rstrip(b"\0")
    nuls = data.count(b"\0")
    if not 0 < nuls <= max(_MOST_NULS * len(data), 2) or decode_head(start.start) is not None:
        return None
    text = decode_head(data.replace(b"\0", b" "))
    if text is None or "\n" not in text:
        return None
    line = data[: data.index(b"\0")].count(b"\n") + 1
    name, stem, end = start.name, PurePath(start.name).stem, PurePath(start.name).suffix
    return (
        f"text that is damaged: {nuls} bytes in it are zero, the first in line {line}: read what is whole, and lose "
        f"that line: tr '\\000' ' ' < {name} > {stem}_mended{end}"
    )


def _text_of_fixed_width(start: Head) -> str | None:
    text = decode_head(start.start)
    if text is None or not fixed_width(text.splitlines()):
        return None
    return f"text in columns of fixed width, with blanks or nothing between them: {by_width(start.name)}"


_OTHERWISE: tuple[Callable[[Head], str | None], ...] = (_text_with_nuls, _text_of_fixed_width)
