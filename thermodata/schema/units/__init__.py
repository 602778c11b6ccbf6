"""Quantities with their one sign convention, and units as labs write them, turned into canonical ones.

Imports no other room of the schema, and is the only place that calls pint.
"""
