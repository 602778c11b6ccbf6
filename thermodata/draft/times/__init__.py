"""When the tests of a folder were: dates, their order of day and month, lengths, and clocks against each other."""
