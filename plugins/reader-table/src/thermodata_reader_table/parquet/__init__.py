"""Parquet: typed columns."""

from thermodata_reader_table.parquet.recording import blocks, describe
from thermodata_reader_table.parquet.row_location import locate

__all__ = ["blocks", "describe", "locate"]
