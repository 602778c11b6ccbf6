"""The views and macros over the store's tables and Parquet files (docs/architecture.md#tables-and-views).

All of them are made anew from the catalogue's tables in the transaction of a commit. Views name their files
one by one: a glob would show files that were never committed.
"""
