"""Commands about models: fit, compare, add, diagnose, predict, show, report.

Imports `terminal` and `look`; computes nothing itself.
"""
