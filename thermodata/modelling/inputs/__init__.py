"""What of the tests goes into a model: which tests, which phases of them, and what drives an effect there.

A driver is a channel or an expression on the test's grid, without gaps; nothing here knows an effect's function.
"""
