"""Steps within a test: what a command makes, what decays, what the machine repeats, and what only a probe does."""
