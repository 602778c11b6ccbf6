"""What a signal is called by its place, where its file names it: campaign files from before may go by the place."""

from __future__ import annotations

BY_PLACE = "place"
"""Of a signal's properties: what it is called by its place in an array whose elements go by names, or in rows whose
values have names before them, where it had one."""
