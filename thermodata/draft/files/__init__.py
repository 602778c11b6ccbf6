"""One file of a folder: who reads it, what it leaves open, a bounded sample of its values, and tests within it."""
