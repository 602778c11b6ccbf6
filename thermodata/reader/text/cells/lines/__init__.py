"""What stands between the cells of a line; lines of other kinds as lines of cells."""
