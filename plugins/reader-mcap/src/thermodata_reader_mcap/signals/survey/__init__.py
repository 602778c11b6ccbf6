"""What a sample of a topic's messages holds: which chunks to open, which fields there are, and of which type."""
