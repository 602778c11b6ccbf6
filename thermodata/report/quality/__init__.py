"""The quality page of a campaign: what was flagged, in numbers, in words, and as a picture a test."""
