"""From weighed candidates to a verdict: what is selected together, what may be claimed of it, and why not the rest.

`investigate` asks all of it of one fitted response.
"""
