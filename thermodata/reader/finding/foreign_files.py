"""Files of measured values that no reader takes, known by their first bytes: what they are, and the one line that makes
a CSV or a Parquet file of them."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import PurePath

from thermodata.plugin import Head
from thermodata.reader.finding.array_files import BY_HDF5, BY_NPZ, BY_XARRAY
from thermodata.reader.text import decode_head
from thermodata.reader.text.file.foreign_texts import BY_PYUFF
from thermodata.reader.text.rows.fixed_width import by_width, fixed_width

_HDF5 = b"\x89HDF\r\n"
_MOST_NULS = 0.2  # of the bytes of a text that was damaged


@dataclass(frozen=True, slots=True)
class _Kind:
    """magic: pattern of the first bytes; what: such a file is; do: what to do, with {name} and {stem} of the file;
    ends: of the names of such files, where the bytes alone are no proof."""

    magic: bytes
    what: str
    do: str
    ends: tuple[str, ...] = ("",)

    def is_of(self, start: Head) -> bool:
        return start.name.lower().endswith(self.ends) and re.match(self.magic, start.start) is not None


_BY_ARROW = (
    'make a Parquet file of it: python -c "import pyarrow.{of} as f, pyarrow.parquet as p; '
    "p.write_table(f.read_table('{{name}}'), '{{stem}}.parquet')\""
)
_BY_CATMAN = "export it from catman as ASCII with channel information, or as MAT"
_KINDS = (
    _Kind(
        b"SQLite format 3",
        "a bag of ROS 2 in SQLite, or another SQLite database",
        "convert a bag to MCAP: ros2 bag convert, or mcap convert {name} {stem}.mcap; of another one export its table "
        'as CSV: sqlite3 -header -csv {name} "select * from TABLE" > {stem}.csv',
        (".db3",),
    ),
    _Kind(
        b"SQLite format 3",
        "an SQLite database",
        'export its table as CSV: sqlite3 -header -csv {name} "select * from TABLE" > {stem}.csv, where sqlite3 {name} '
        ".tables names the tables",
    ),
    *(
        _Kind(magic, "netCDF-4 (HDF5)", BY_XARRAY.replace("{with}", "h5netcdf"), ends)
        for magic, ends in ((_HDF5 + rb"[\s\S]*_NCProperties", ("",)), (_HDF5, (".nc", ".nc4", ".cdf")))
    ),
    _Kind(_HDF5, "HDF5, and no MAT file", BY_HDF5),
    _Kind(b"CDF[\x01\x02\x05]", "netCDF (classic)", BY_XARRAY.replace("{with}", "scipy")),
    _Kind(rb"PK\x03\x04[\s\S]{26}[^/\\\0]{1,200}\.npy", "arrays of NumPy by their names (NPZ)", BY_NPZ),
    *(_Kind(magic, "Feather (Arrow)", _BY_ARROW.format(of="feather")) for magic in (b"ARROW1", b"FEA1")),
    _Kind(b"ORC", "ORC", _BY_ARROW.format(of="orc")),
    _Kind(
        rb"\x80[\x02-\x05][\x95}\]c(]",
        "a pickle of Python, which is never opened, for it runs what stands in it",
        'where you trust it, make a Parquet file of it: python -c "import pandas; '
        "pandas.DataFrame(pandas.read_pickle('{name}')).to_parquet('{stem}.parquet')\"",
    ),
    _Kind(
        b"\x93NUMPY",
        "an array of NumPy",
        "name its columns in a CSV: python -c \"import numpy; numpy.savetxt('{stem}.csv', numpy.load('{name}'), "
        "delimiter=',', header='time [s],T_1 [degC]', comments='')\", with the names and units that are right",
    ),
    _Kind(b"Obj\x01", "Avro", "export it as CSV or Parquet from what wrote it"),
    _Kind(rb"PK\x03\x04[\s\S]{26}mimetypeapplication/vnd\.oasis\.opendocument\.spreadsheet", "ODS", "save it as XLSX"),
    _Kind(
        rb"PK\x03\x04[\s\S]*?word/(?:document|styles|settings|_rels)",
        "a document of Word",
        "save a table in it as XLSX or CSV",
    ),
    _Kind(
        b"File format: Tinytag",
        "a file of Tinytag Explorer, with a ZIP in it",
        "export it from Tinytag Explorer as CSV, or take its readings out: unzip -p {name} "
        "export/readings.csv > {stem}.csv",
    ),
    _Kind(
        rb"[\s\S]{0,8}DEWESoft",
        "a recording of Dewesoft X",
        "export it from DewesoftX as MAT, CSV or MDF",
        (".dxd", ".d7d"),
    ),
    _Kind(rb"\s{0,9}-1\s+58b\s", "a universal file (UFF 58b) with binary sets", BY_PYUFF.replace("FILE", "{name}")),
    _Kind(rb"\|CF,", "FAMOS of imc", "export it from imc FAMOS or imc STUDIO as CSV or TDMS"),
    _Kind(
        rb"(?:\xef\xbb\xbf)?<\?xml[^>]*>\s*<usi:tdm",
        "the header of a TDM data set of NI",
        "save it as TDMS from DIAdem",
    ),
    _Kind(b"DIAEXTENDED", "the header of a DIAdem data set", "save it as TDMS from DIAdem"),
    _Kind(rb"[\x91-\x94]\x13[\s\S]{2}\x00\x00", "a binary file of catman", _BY_CATMAN, (".bin",)),
    _Kind(rb"\x71\x17\x00\x00", "a binary file of an HBM amplifier (MEA)", _BY_CATMAN, (".mea",)),
    _Kind(
        rb"\x00[\x64-\x7f]\x00[\s\S]\x00[ -~]{3}|\x01\x00[\x64-\x7f]\x00[\s\S][ -~]{3}",
        "UDBF of Gantner",
        "export it as CSV from GI.bench",
    ),
)


def foreign_kind(start: Head) -> str | None:
    """What a file is that its first bytes name, and what to do; None for all others."""
    found = next((k for k in _KINDS if k.is_of(start)), None)
    if found is None:
        return None
    do = found.do.replace("{name}", start.name).replace("{stem}", PurePath(start.name).stem)
    return f"{found.what}: {do}"


def foreign_file(start: Head) -> str | None:
    """The same, also of texts that are damaged or of fixed width."""
    if (kind := foreign_kind(start)) is not None:
        return kind
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
