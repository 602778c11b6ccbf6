"""A law taken apart into linear paths: which filter leads from which drive to the response.

What is no sum of filtered drives has no coefficients to show; it runs in a control all the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from thermodata.effect import law
from thermodata.effect.law_text import written
from thermodata.effect.linear import Filter, lag_filter


@dataclass(frozen=True)
class Path:
    """drive: static, of roles. times: what the answer is multiplied by (a position), or None. holds: while this is so
    (a lag that is another while the spindle stands), or None."""

    drive: law.Node
    by: Filter
    times: law.Node | None = None
    holds: str | None = None


class CurvedError(Exception):
    """The law is no sum of filtered drives."""


def paths(node: law.Node) -> list[Path]:
    """The linear paths of a law; those of one drive are one. CurvedError where it has none."""
    made: dict[tuple[law.Node, law.Node | None, str | None], Path] = {}
    for path in _paths(node):
        key = (path.drive, path.times, path.holds)
        made[key] = path if key not in made else replace(path, by=made[key].by + path.by)
    return list(made.values())


def _paths(node: law.Node) -> Iterator[Path]:
    match node:
        case law.Binary("*", law.Number(value), right):
            yield from (replace(p, by=p.by.scaled(value)) for p in _paths(right))
        case _ if law.is_static(node):
            yield Path(node, Filter(direct=1.0))
        case law.Lag(of, law.Number(tau)) if law.is_static(of):
            yield Path(of, lag_filter(tau))
        case law.Lag(of, law.Where(condition, law.Number(then), law.Number(other))) if law.is_static(of):
            yield Path(of, lag_filter(then), holds=written(condition))
            yield Path(of, lag_filter(other), holds=f"not {written(condition)}")
        case law.Delay(of, law.Number(dead)) if law.is_static(of):
            yield Path(of, Filter(late=((dead, 1.0),)) if dead > 0 else Filter(direct=1.0))
        case law.Filtered(of, by) if law.is_static(of):
            yield Path(of, by)
        case law.Binary("+", left, right):
            yield from _paths(left)
            yield from _paths(right)
        case law.Binary("-", left, right):
            yield from _paths(left)
            yield from (replace(p, by=p.by.scaled(-1.0)) for p in _paths(right))
        case law.Binary("*" | "/" as operator, left, law.Number(value)):
            factor = value if operator == "*" else 1.0 / value
            yield from (replace(p, by=p.by.scaled(factor)) for p in _paths(left))
        case law.Binary("*", left, right) if law.is_static(right):
            yield from (_times(p, right) for p in _paths(left))
        case law.Binary("*", left, right) if law.is_static(left):
            yield from (_times(p, left) for p in _paths(right))
        case _:
            raise CurvedError(written(node))


def _times(path: Path, factor: law.Node) -> Path:
    return replace(path, times=factor if path.times is None else law.Binary("*", path.times, factor))
