"""How a version of a model says which tests it is made without, where it is made and where it is told."""

from __future__ import annotations

MADE_WITHOUT = "made without"
"""Begins the note of each test that is left out, before its id."""
