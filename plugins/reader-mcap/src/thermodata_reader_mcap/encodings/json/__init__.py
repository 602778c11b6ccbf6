"""JSON messages: by the standard library, or many at once by Arrow."""
