"""What the store holds of a campaign already, and what of it differs since."""
