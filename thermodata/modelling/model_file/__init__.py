"""From a model file to terms that stand on channels, and the effects that no plugin gives.

A file names an effect of a plugin, spells one out as a transfer function, or takes one from another model's or another
program's prediction.
"""
