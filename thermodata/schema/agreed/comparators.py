"""How two numbers are compared: in the expressions that users write, and in the law of an effect."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from typing import Any, Literal

Comparator = Literal["<", "<=", ">", ">=", "==", "!="]
COMPARE: Mapping[Comparator, Callable[[Any, Any], Any]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}
