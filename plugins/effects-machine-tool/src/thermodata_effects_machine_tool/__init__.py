"""Thermal effects of machine tools. Each is found through its entry point; nothing here is imported by the core.

Bounds and gains: figures from the literature where there are any, else judgement (docs/effects.md lists them all,
docs/method.md the literature). An effect's docstring holds its equation, units and source.
Time constants are in minutes, gains in um per unit of the driver.
"""
