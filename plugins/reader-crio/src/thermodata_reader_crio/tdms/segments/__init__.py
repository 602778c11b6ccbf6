"""From the bytes of a file to its index: lead-ins, lists of objects, chunks, and where a damaged file goes on."""
