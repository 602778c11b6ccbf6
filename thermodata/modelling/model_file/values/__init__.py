"""Values that a model file gives: their units, what none can have, and the conditions that a gain differs by."""
