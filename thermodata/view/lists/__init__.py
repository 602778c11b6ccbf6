"""What stands in a store, as rows to look through: tests, models with their errors, events, units of responses.

Imports no other room of the view.
"""
