"""Files of a folder that are no logs of their own: copies, packed ones, and settings."""
