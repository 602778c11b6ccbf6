"""Sinumerik: traces as XML and as CSV."""
