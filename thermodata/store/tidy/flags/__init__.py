"""Quality flags of streams of any length, when a test measures, and which flags a person overruled.

Imports `values` and what is below it; changes no value and writes no file.
"""
