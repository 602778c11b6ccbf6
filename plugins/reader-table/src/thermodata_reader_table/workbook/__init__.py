"""XLSX: every sheet that is a table."""

from thermodata_reader_table.workbook.recording import blocks, describe, locate

__all__ = ["blocks", "describe", "locate"]
