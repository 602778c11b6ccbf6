"""Files before anybody reads them: whether they are regular, packed, pieces of one log, or a store's.

Imports no other room of the readers: names and first bytes only.
"""
