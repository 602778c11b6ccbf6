"""How times are written in a column, and what they say in nanoseconds: stamps, days, spans, parts of a date, zones."""
