"""The jump test: known moves, the voltage that answers, and a signed sensitivity."""
