"""Files into tests: by their names, their times, or a list of the tests."""
