"""What a fit says of itself: one row a check, with a threshold and what to do."""
