"""When a test measures, chunk by chunk, and which flags hold of the rest of it."""
