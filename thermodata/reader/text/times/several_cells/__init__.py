"""A time of which several cells say a part each: its date, its day, its half of the day, its zone."""
