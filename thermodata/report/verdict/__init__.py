"""A verdict in words: what is missing, what it could be else, what refines the model, and what it leaves.

Imports `words` only: plain answers in, sentences out, for the terminal as for a page.
"""
