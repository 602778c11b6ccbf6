"""What the beginnings and ends of logs, and their times, say of clocks."""
