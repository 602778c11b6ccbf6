"""What tests tell of a channel beside each other: sensors that failed, parts that belong to another test."""
