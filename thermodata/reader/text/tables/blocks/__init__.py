"""The rows of a table in blocks, with times, flags and places."""
