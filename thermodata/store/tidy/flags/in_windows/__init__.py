"""A stream judged in windows that overlap: where it is cut, what lies ahead of a window, what is kept of it."""
