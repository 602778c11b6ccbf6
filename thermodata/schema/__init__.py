"""The files that users write, the answers that they get, and the words, units and flags of both.

`flag` and the published documents (`publish`, `publish_places`) stand beside the rooms. Nothing here imports another
floor than `errors`.
"""
