"""What is told of the user's own model: as it is stored, and as it would be with what a verdict names."""
