"""Jump tests and signs: what turns a displacement to the machine's axes."""
