"""What a screen draws of a test: channels in a stretch, predictions, residuals, contributions, a rule's stretch.

Imports `query` and `grid`; draws nothing itself.
"""
