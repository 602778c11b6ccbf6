"""Commands before there is a store to look into: demo, simulate, init, sniff, preview, ingest.

Imports `terminal` only; what they do is done by the floors below.
"""
