"""The next version of a model: what a diagnosis adds to it or takes back, a second lag, and the id that names it."""
