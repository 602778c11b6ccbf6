"""Files as they stand on the disk: regular ones, packed ones, and those in archives."""
