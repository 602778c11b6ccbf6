"""SQL over a store: `StoreView`, what a query may do, and what its answer is: units, samples that don't count.

Imports `grid` only; a query of somebody whom nobody watches goes by `sandbox`.
"""
