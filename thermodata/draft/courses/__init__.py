"""What the recordings show of a test: its kind, what moved or turned, when it measures, whether it began warm."""
