"""How a table lies on its page: where its data begin, which rows are its header, and which name stands over which
column."""
