"""OPC UA: tables that loggers write."""
