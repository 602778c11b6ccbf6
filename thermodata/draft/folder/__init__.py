"""The files of a folder together: into sources and tests, copies and parts, and the tables beside them."""
