"""MDF 3 and 4, the ASAM measurement data format."""

from thermodata_reader_table.mdf.recording import blocks, describe
from thermodata_reader_table.mdf.row_location import locate

__all__ = ["blocks", "describe", "locate"]
