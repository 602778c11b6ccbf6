"""Messages of brokers and edge devices in JSON."""
