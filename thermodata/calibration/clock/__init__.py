"""The clock of one log against another's."""
