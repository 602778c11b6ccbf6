"""A recording's topics as streams: which fields are signals, which times are theirs, and the blocks."""
