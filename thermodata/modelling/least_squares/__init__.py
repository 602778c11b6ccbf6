"""The one problem behind every fit: gains are linear and solved for, time constants are searched.

Columns of all terms over all tests, their Gram matrices, and variable projection on them [golub1973].
"""
