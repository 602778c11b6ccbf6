"""Heidenhain: recordings of TNCscope."""
