"""What makes a claim of a candidate: the rules with their limits, and how probable it is that it is what is missing.

Beside them what only refines the model, what other axes say, and how small an effect could be named at all.
"""
