"""The keeping of a store: checking its files, forgetting and cleaning up, and taking all of it away as one file."""
