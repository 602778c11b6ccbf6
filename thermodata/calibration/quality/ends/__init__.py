"""The ends of a sensor's range: declared by nobody, seen by where readings stay and come to the same extreme."""
