"""The gantry milling centre: a machine as a network of cells, whose hidden effects are those of the library."""
