"""Which unit a signal is in: by the end of its name, a standard, its values, and where they disagree."""
