"""What comes from one reading to the next: spikes, their edges, and steps that stay."""
