"""Names and places of logs: pieces of one log, and folders that are stores.

Imports no other room of the readers: names and first bytes only.
"""
