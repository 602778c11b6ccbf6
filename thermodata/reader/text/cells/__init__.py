"""What one cell says, the same whoever claims the file: a number, a time, a status, a word for nothing; and what
stands between the cells of a line."""
