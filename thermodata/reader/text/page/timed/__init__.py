"""Which columns of a page share one time, and what that counts from."""
