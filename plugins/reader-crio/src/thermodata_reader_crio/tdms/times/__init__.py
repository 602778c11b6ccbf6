"""Channels that hold the times of others."""
