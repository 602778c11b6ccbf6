"""Protobuf messages, by Google's own package."""
