"""The draft as the lines of a campaign file, answers put into them, and a first model beside it."""
