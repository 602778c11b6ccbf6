"""The rows of one stream in time order, over all files that a test consists of, and how they were written.

Imports no other room of the tidy layer: no campaign file, no clock of another source.
"""
