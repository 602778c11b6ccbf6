"""A law as a person writes it: F_20 min{T}."""

from __future__ import annotations

from thermodata.effect import law


def written(node: law.Node) -> str:
    """The tree as a person writes it."""
    return _text_of(node, 0)


_RANK = {"+": 1, "-": 1, "*": 2, "/": 2, "**": 3}


def _text_of(node: law.Node, outer: int) -> str:
    match node:
        case law.Number(value):
            return f"{value:.6g}"
        case law.Symbol(name):
            return name
        case law.Absolute(of):
            return f"|{_text_of(of, 0)}|"
        case law.Binary(operator, left, right):
            rank = _RANK[operator]
            text = f"{_text_of(left, rank)} {operator} {_text_of(right, rank + 1)}"
            return f"({text})" if rank < outer else text
        case law.Compare(operator, left, right):
            return f"{_text_of(left, 1)} {operator} {_text_of(right, 1)}"
        case law.Logic("not", of):
            return f"not ({_text_of(of[0], 0)})"
        case law.Logic(operator, of):
            return f" {operator} ".join(f"({_text_of(one, 0)})" for one in of)
        case law.Where(condition, then, other):
            return f"({_text_of(then, 0)} where {_text_of(condition, 0)}, else {_text_of(other, 0)})"
        case law.Lag(of, tau):
            return f"F_{_time(tau)}{{{_text_of(of, 0)}}}"
        case law.Delay(of, dead):
            return f"{_text_of(of, 3)}(t - {_time(dead)})"
        case law.Filtered(of, by):
            return f"H{len(by.modes)}{{{_text_of(of, 0)}}}"
    raise TypeError(type(node))


def _time(node: law.Node) -> str:
    if isinstance(node, law.Number):
        return f"{node.value / 60:.4g} min"
    if isinstance(node, law.Where):
        return f"[{_time(node.then)} where {_text_of(node.condition, 0)}, else {_time(node.other)}]"
    return _text_of(node, 0)
