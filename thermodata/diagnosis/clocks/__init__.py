"""Whether a log's clock is off: by what commands move at once, by heat, and by how logs begin and end.

In all tests, in one, or on one side of a day; and the logs with their clocks moved.
"""
