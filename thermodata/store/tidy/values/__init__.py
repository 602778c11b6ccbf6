"""The values of a test's channels: calibrated, in chunks, on their own rows or on another stream's.

Imports `clock` and what is below it; judges no value.
"""
