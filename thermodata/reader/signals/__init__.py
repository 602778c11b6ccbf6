"""What rows and headers say of signals: several series below each other, units in rows, changes, names.

Imports `times` at most; no text, so that workbooks and Parquet go by the same rules.
"""
