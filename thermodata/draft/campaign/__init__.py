"""The draft of a campaign as plain data: its sources, channels, calibrations, tests, and what is asked."""
