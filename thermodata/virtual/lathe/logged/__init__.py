"""What its laboratory logs: sensors with their habits, what breaks, and what a test leaves behind."""
