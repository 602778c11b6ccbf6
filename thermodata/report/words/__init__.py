"""Figures in words, in one unit and with a sign, and what the words for errors mean: the same on every page.

Imports no other room of the report, and knows no store.
"""
