"""Fitting: all calibration tests together, in stages where effects have tests of their own, and orders left open.

`model` is the whole; see `thermodata.modelling.fit_model`.
"""
