"""From a campaign file and its raw files to one commit: find files, read them, tidy, and tell what was lost.

Safe to repeat and safe to kill: bulk is written first, and becomes visible in one transaction.
"""
