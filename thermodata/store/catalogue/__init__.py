"""The catalogue: `Store` with its turnstile, its tables and their format, and the rows of models.

One DuckDB file that is open for milliseconds. What is bulk lives in Parquet files that its rows name.
"""
