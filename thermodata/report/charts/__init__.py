"""Pictures of what is collected: charts and heat maps of plain values, bars as SVG, a system as a PNG.

Imports `collected` and what is below it; no template, no page.
"""
