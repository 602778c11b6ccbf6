"""What a test consists of: which channel is which signal of which stream, or derived, or known beforehand.

Imports `rows` only; reads no values.
"""
