"""What a signal measures, by its unit, its name and its values, in this order."""
