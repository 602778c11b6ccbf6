"""Candidates weighed: evidence in the noise of a response, beside all others, against chance and left-out tests.

Also those that change an effect of the model instead of adding one.
"""
