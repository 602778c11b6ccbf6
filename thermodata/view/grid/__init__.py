"""The data that models are fitted to: tests on one uniform grid with masks, and what the catalogue says of them.

Imports no other room of the view; asks DuckDB for bins, never for a user's query.
"""
