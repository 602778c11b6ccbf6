from __future__ import annotations

import sys
from pathlib import Path

# so that the tests find the data made beside them (pytest's importlib mode adds no path)
sys.path.insert(0, str(Path(__file__).parent))
