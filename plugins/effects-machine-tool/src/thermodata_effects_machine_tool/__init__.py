"""Thermal effects of machine tools. Each is found through its entry point; nothing here is imported by the core.

Bounds and gains: paper figures where there are any, else judgement (see the README's table of effects).
Time constants are in minutes, gains in um per unit of the driver.
"""
