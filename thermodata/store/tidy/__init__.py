"""The tidy layer: calibrated channels with their flags, on one time line a test.

A test's plan says which channel is which signal; clocks make one time line of its sources; streams of any length are
read, calibrated and judged in chunks; a content key says whether a file of it is there already.
"""
