"""MTConnect: what an agent answers, and what an adapter sends (SHDR)."""
