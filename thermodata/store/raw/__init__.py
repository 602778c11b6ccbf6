"""The raw layer: what a source file said, as Parquet, one file a stream, made once and final.

Source files that may grow while they are read, clocks that were set, and the order of rows in time belong here too.
"""
