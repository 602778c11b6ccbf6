"""One candidate of an answer: its figures, and why it is claimed or not, rung by rung and in a sentence."""
