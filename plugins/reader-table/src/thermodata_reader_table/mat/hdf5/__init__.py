"""MAT files of version 7.3, which are HDF5: held against what they declare, then read."""
