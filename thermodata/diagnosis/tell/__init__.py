"""What an answer says: which candidates are listed, why each is claimed or not, rung by rung, and what to test next."""
