"""What a campaign file declares beside what there is: left open, misspelt, or of nothing."""
