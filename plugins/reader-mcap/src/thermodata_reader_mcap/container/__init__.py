"""The MCAP file itself: records, chunks, the summary, definitions of channels, and messages in their order."""
