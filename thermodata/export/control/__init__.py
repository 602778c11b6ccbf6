"""A model frozen for a control: a self-contained program that is called at a fixed cycle.

program.py   what the program is: inputs, drives, states, terms, limits
body.py      what it does in one cycle, as statements that every language has
c.py st.py python.py   those statements, written in a language
data.py      the same as numbers: JSON and MAT
"""

from __future__ import annotations

from thermodata.export.control.build import build
from thermodata.export.control.program import Input, Limits, Program
from thermodata.export.control.write import TARGETS, Written, write

__all__ = ["TARGETS", "Input", "Limits", "Program", "Written", "build", "write"]
