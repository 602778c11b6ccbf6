"""TDMS, National Instruments' binary log: segments with metadata and raw data, DAQmx included."""

from thermodata_reader_crio.tdms.recording import blocks, describe
from thermodata_reader_crio.tdms.row_location import locate

__all__ = ["blocks", "describe", "locate"]
