"""How far a fit is to be trusted: intervals, profiles, and checks that say what to do.

A residual of a thermal test hangs together for an hour, so that hundreds of samples are worth a dozen.
"""
