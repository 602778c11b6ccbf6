"""The way back: from a value in the store to the row of a source file, its hash, calibrations and sign."""
