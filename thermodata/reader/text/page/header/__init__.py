"""What the rows above the data name: which of them are the header, and which name stands over which column."""
