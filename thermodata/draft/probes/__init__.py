"""What moves a probe: jump tests, whose they are, and which way a displacement points."""
