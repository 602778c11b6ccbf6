"""Raw numbers and texts of a channel, by the chunks that hold them."""
