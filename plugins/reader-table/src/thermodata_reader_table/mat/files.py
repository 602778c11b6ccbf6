"""A MAT file of either version as a tree of variables."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from thermodata.errors import FormatError
from thermodata_reader_table.mat.tree import Tree


def is_hdf5(start: bytes) -> bool:
    """Whether a file's first kilobyte holds the signature of HDF5 (after MATLAB's block of 512 bytes)."""
    return any(start[at : at + 8] == b"\x89HDF\r\n\x1a\n" for at in (0, 512))


@contextmanager
def opened(path: Path) -> Iterator[Tree]:
    """The variables of a MAT file of either version."""
    with path.open("rb") as file:
        start = file.read(1024)
    if is_hdf5(start):
        try:
            from thermodata_reader_table.mat.hdf5 import variables as hdf5
        except ImportError:
            raise FormatError("MAT 7.3 (HDF5) needs h5py", where=path.name, hint="pip install h5py") from None
        with hdf5.opened(path) as tree:
            yield tree
        return
    from thermodata_reader_table.mat.version5 import variables as version5

    yield version5.read(path)
