"""Commands that look into a store or take data out of it: tests, channels, quality, trace, sql, export.

Imports `terminal` and `start`; changes no store.
"""
