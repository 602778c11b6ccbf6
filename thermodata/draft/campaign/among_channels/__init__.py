"""What drafted channels say of each other, and what is asked of several at once."""
