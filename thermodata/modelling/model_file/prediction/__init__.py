"""Another program's prediction as an effect: its file, the rows in it, and these on the grid of a test."""
