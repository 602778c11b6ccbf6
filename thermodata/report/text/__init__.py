"""Answers as text for a person, in the terminal and in a notebook: tables, a fit, a verdict, what to do next.

Imports `collected` and what is below it; no charts, no page.
"""
