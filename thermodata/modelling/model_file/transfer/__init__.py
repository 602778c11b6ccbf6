"""Transfer functions as effects: identified or given, their law, and what their printed digits say."""
