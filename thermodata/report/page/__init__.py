"""The page of a model: its first words, its errors, its template, style and script; and how a page is written.

Imports all rooms but `quality`, whose page is written in the same way.
"""
