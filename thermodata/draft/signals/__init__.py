"""What a signal is: its quantity, unit and place, by name, unit and values, and how sure that is."""
