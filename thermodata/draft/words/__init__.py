"""What words say, in the languages of labs: names taken apart, places, axes, roles, and the names of files."""
