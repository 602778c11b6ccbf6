"""What fit, diagnose and confirm answer, as JSON: keys that don't apply are null, never absent.

Imports no other room: an answer is plain values with their units in their names.
"""
