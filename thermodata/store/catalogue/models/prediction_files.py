"""The Parquet files that hold what a model predicts, one a campaign, test and response."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.store.base.encoder import COMPRESSION
from thermodata.store.base.files import publish, safe_name, temporary, write_error

if TYPE_CHECKING:
    import pyarrow as pa


def write_prediction(store: Path, model: str, key: tuple[str, str, str], table: pa.Table) -> str:
    """The file's path in the store. key: campaign, test, response. StoreError where it can't be written."""
    import pyarrow.parquet as pq

    name = "__".join(safe_name(part, 50) for part in key) + ".parquet"
    target = store / "model" / safe_name(model) / name
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise write_error(target, error) from error
    part = temporary(target)
    try:
        pq.write_table(table, part, compression=COMPRESSION, row_group_size=100_000)
        publish(part, target)
    except OSError as error:
        raise write_error(target, error) from error
    finally:
        with contextlib.suppress(OSError):
            part.unlink()
    return target.relative_to(store).as_posix()
