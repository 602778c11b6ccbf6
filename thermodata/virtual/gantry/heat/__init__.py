"""Where the heat comes from, how it flows through the cells, and what sensors read of it."""
