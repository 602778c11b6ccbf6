"""What every machine of the blind benchmark says of itself: its truth, and how an answer is held against it."""
