"""What the signals of one source are as channels: named, guessed, or left out."""
