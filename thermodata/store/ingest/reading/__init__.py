"""Which files a campaign names, and their way into the raw layer."""
