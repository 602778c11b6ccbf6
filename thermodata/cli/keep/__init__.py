"""Commands that keep a store and its program: check, forget, gc, plugins, the published documents.

Imports `terminal` and `look`; knows no model.
"""
