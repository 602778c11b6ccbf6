"""Which candidates are listed, in what order, and which errors and probabilities are told of each."""
