"""Files as they stand on the disk: regular ones, packed ones, those in archives, and workbooks."""
