"""What a cell of a value says, the same whoever claims the file: a number, a truth value, a status, nothing."""
