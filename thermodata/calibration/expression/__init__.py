"""Expressions over channels: their tree, their parser, and their evaluation with units."""
