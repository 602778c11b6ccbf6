"""Words that all floors use: names and counts in a sentence, places, names of zones, slips of the pen.

Imports no other room of the schema: what is said is the same of every file and every answer.
"""
