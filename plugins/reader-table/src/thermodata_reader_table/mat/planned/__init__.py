"""Which variables are times, which are signals of them, and which name or describe others."""
