"""What every room of the store stands on: files that appear whole, Arrow and Parquet, DuckDB's settings, counting.

Nothing here knows what a store holds.
"""
