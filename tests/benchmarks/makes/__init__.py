"""Simulated machines with their laboratories, each a package: `write(folder, case)` writes a campaign and its truth.

Each was made by somebody who had not read the diagnosis: its bodies, causes, sensors and constants are the maker's own.
What they do alike stands in the modules beside them. From `tests/benchmarks`, to look at one:

    uv run python -m makes small_mill FOLDER CASE [CASE ...]
"""
