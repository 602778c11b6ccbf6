"""Which reader takes a file, why, and what it would give; which of its signals a campaign file means.

Imports all rooms below it; nothing of the readers imports it.
"""
