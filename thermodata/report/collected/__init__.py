"""What a page shows, as plain values: a model's tests, versions, errors and weak spots, from a store.

Imports `words` and `verdict`; draws nothing and knows no template.
"""
