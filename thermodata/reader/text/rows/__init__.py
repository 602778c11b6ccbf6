"""The rows of a table as typed columns, each with its line; rows that are none, are bad, or hold changes alone."""
