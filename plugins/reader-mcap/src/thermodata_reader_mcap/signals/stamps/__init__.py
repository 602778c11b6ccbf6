"""Times that stand in the messages themselves, and whether they tell others than the log times."""
