"""What a header says: names, units, which column is called a time; which rows are a header, and cells with a unit."""
