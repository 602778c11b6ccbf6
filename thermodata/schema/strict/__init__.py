"""How a file of a user is read whatever it is of: YAML with lines, strict models, a mistake with the nearest word.

Imports `units` and `words`; knows no campaign and no model.
"""
