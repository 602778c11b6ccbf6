"""Drafts a campaign file from a folder that was never seen before: groups, guesses, and marked questions."""
