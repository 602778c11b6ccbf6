"""What one stream tells of its quality: wrong times, and values that no machine made."""
