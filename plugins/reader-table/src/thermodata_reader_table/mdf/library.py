"""asammdf, which reads MDF: opened for pieces of bounded size, with its errors as ours."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from thermodata.errors import FormatError, ThermodataError
from thermodata_reader_table.mdf.damage import damaged

INSTALL = "pip install 'thermodata-reader-table[mdf]'"
_FRAGMENT = 16 << 20


@contextmanager
def damage_as_format_error(where: str) -> Iterator[None]:
    """asammdf raises errors of any class for a damaged file; all of them mean the same."""
    try:
        yield
    except (ThermodataError, GeneratorExit):
        raise
    except Exception as error:  # MemoryError too: pieces are small, so only a damaged length asks for that much
        raise damaged("a damaged MDF file", where=where, got=f"{type(error).__name__}: {error}"[:200]) from None


def _end(file: Any) -> None:
    """The end of asammdf's object, as it is but for stderr: it closes, and misses what its constructor had not made
    where that gave up."""
    with suppress(Exception):
        file.close()


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """asammdf's file. FormatError: damaged; or the library is not installed."""
    try:
        import asammdf
        from asammdf.blocks.mdf_v4 import MDF4
    except ImportError:
        raise FormatError("MDF needs asammdf, which is not installed", where=path.name, hint=INSTALL) from None
    MDF4.__del__ = _end
    logging.getLogger("asammdf").setLevel(logging.CRITICAL)  # what it would say comes as losses and notes
    mdf = None
    try:
        with damage_as_format_error(path.name):
            mdf = asammdf.MDF(path, raise_on_multiple_occurrences=False)
            mdf.configure(read_fragment_size=_FRAGMENT)
        yield mdf
    finally:
        if mdf is not None:
            mdf.close()
