"""What the sampled cells of a table say of its columns: their kinds, their decimal mark, their zone."""
