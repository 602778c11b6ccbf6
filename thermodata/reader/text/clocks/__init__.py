"""Which columns of a table are its time, or the times of some of its columns; and what to ask where none says so."""
