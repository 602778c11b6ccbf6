"""A diagnosis by rules that are set by hand, beside the evidence of thermodata: `tests/benchmarks/hand_rules.py`."""
