"""Puts the root of the checkout on the path, as run.py does, for the modules of tests/fuzz."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = str(Path(__file__).parents[2])
if ROOT not in sys.path:
    sys.path.insert(0, ROOT)
