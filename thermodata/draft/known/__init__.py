"""New logs of a machine that the store knows, drafted by its campaign: what a model is to predict."""
