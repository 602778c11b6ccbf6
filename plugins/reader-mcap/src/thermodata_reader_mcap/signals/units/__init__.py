"""Units that messages say of their fields, and channels of their topics."""
