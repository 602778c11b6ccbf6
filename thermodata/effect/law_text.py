"""A law as a person writes it: F_20 min{T}."""

from __future__ import annotations

from thermodata.effect import law


def written(node: law.Node) -> str:
    """The tree as a person writes it."""
    return _written(node, 0)


_RANK = {"+": 1, "-": 1, "*": 2, "/": 2, "**": 3}


def _written(node: law.Node, outer: int) -> str:
    match node:
        case law.Number(value):
            return f"{value:.6g}"
        case law.Symbol(name):
            return name
        case law.Absolute(of):
            return f"|{_written(of, 0)}|"
        case law.Binary(operator, left, right):
            rank = _RANK[operator]
            text = f"{_written(left, rank)} {operator} {_written(right, rank + 1)}"
            return f"({text})" if rank < outer else text
        case law.Compare(operator, left, right):
            return f"{_written(left, 1)} {operator} {_written(right, 1)}"
        case law.Logic("not", of):
            return f"not ({_written(of[0], 0)})"
        case law.Logic(operator, of):
            return f" {operator} ".join(f"({_written(one, 0)})" for one in of)
        case law.Where(condition, then, other):
            return f"({_written(then, 0)} where {_written(condition, 0)}, else {_written(other, 0)})"
        case law.Lag(of, tau):
            return f"F_{_time(tau)}{{{_written(of, 0)}}}"
        case law.Delay(of, dead):
            return f"{_written(of, 3)}(t - {_time(dead)})"
        case law.Filtered(of, by):
            return f"H{len(by.modes)}{{{_written(of, 0)}}}"
    raise TypeError(type(node))


def _time(node: law.Node) -> str:
    if isinstance(node, law.Number):
        return f"{node.value / 60:.4g} min"
    if isinstance(node, law.Where):
        return f"[{_time(node.then)} where {_written(node.condition, 0)}, else {_time(node.other)}]"
    return _written(node, 0)
