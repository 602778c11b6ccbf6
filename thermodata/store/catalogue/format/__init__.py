"""What a catalogue is made of: its tables and documents, a new one, and an older one brought up."""
