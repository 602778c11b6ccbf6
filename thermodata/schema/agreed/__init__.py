"""What one floor writes and another must say alike or find again: ids of effects, phrases, marks in files.

Imports `words` only; who writes and who reads import this, never each other.
"""
