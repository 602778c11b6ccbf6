"""How a date, a time of day and a zone are written. What they say in nanoseconds: `times/`."""
