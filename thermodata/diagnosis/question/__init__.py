"""The question that a diagnosis asks, as plain arrays: what the model leaves over, and what it can do already.

The noise of what is left, the effects of the model as a prior, and the windows where the residual stands out.
"""
