"""MAT files of MATLAB, version 5 and 7.3."""

from thermodata_reader_table.mat.recording import blocks, describe
from thermodata_reader_table.mat.row_location import locate

__all__ = ["blocks", "describe", "locate"]
