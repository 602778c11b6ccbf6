"""Messages that hold several samples each: which arrays these are, and their times."""
