"""A text file before it is a table: its encoding, whole lines in bounded memory, where a row stands, what is lost.

Also the texts that hold no table at all.
"""
