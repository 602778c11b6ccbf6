"""What a damaged Parquet file is told as."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from thermodata.errors import FormatError


@contextmanager
def damage_as_format_error(path: Path) -> Iterator[None]:
    """pyarrow raises several unrelated classes for a damaged file; all of them mean the same."""
    import pyarrow as pa

    try:
        yield
    except (pa.ArrowException, OSError, ValueError, OverflowError, MemoryError, KeyError, IndexError) as error:
        raise FormatError(
            "not a readable Parquet file",
            where=path.name,
            got=(str(error).splitlines() or ["?"])[0],
            hint="write or copy it again: a Parquet file whose end is missing can't be read",
        ) from None
