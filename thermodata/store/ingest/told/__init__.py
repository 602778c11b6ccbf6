"""What an ingest says of a campaign: losses, and what is worth knowing."""
