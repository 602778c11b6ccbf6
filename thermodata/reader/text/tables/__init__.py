"""A whole table: the first look that finds it, and its rows in blocks with times, flags and places."""
