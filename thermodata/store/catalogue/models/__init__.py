"""The rows of models: fits and predictions, what was found out about them, and whether their data changed since."""
