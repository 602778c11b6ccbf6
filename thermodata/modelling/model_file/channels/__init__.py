"""Which channels a model file means: of its responses, and of what drives its effects."""
