"""Faults of sensors that look like physics: a probe that is turned or whose gain is wrong, one that came loose."""
