"""What to do next: which test to run, and which sensor to add."""
