"""A reader held to its contract: the rules of its data, the guard before all others, what it must heed.

Imports `files` only: it knows no format and no reader by name.
"""
