"""What times mean, however they are written: zones, units, epochs, clocks that leap or go back; what is asked.

Imports no other room of the readers, so that text and typed tables say the same of one clock.
"""
