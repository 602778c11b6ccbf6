"""The temperatures of the lathe: its bodies as rods, its hall, what heats and cools them, and their march in time."""
