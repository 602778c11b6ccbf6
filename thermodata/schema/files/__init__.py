"""The campaign file and the model file: their keys, what each must refer to, and how they are loaded.

Imports no answers: what is written does not depend on what comes of it.
"""
