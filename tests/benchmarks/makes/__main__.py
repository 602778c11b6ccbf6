"""Write cases of one make: `python -m makes MAKE FOLDER CASE [CASE ...]` writes FOLDER/CASE_NN each."""

from __future__ import annotations

import json
import sys
from importlib import import_module
from pathlib import Path

make, folder, *cases = sys.argv[1:]
for case in map(int, cases):
    print(json.dumps(import_module(f"makes.{make}").write(Path(folder) / f"CASE_{case:02d}", case)))
