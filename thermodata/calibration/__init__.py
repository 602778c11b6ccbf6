"""From what a file said to calibrated, sign-normalised, described values: scalings, jump tests, flags, clocks.

Import what you need from the modules themselves; this package stays light for `--help`.
"""
