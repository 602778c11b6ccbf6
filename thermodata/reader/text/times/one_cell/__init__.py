"""A time that stands in one cell: stamps, spans, the letters that they are written in."""
