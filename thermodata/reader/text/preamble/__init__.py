"""What the lines above a table say of its times: when its rows began, from row to row, and in which zone."""
