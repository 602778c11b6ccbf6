"""The raw logs as a lab has them: TDMS of the probes, the control's CSV, MCAP of the hall, and their campaign file."""
