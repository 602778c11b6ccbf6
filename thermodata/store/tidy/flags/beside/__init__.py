"""What is known of a channel only beside other tests, from what is kept of each of its chunks."""
