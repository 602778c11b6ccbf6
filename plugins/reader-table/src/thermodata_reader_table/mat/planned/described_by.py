"""Lists of names and units in a MAT file, and whose columns they describe: X_names and X_units are of X alone."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from thermodata_reader_table.mat.planned.stream_plan import Listed, Plan, Scope, upwards


def settle_lists(plan: Plan, scope: Scope) -> None:
    """Lists called after no variable of the scope ('tempNames' beside T) to its one matrix that has as many columns and
    no list of its own; where there are several of either, nobody can tell, and nothing is called by them. Without
    matrices beside it, a list stands for those in the structs below."""
    if not scope.matrices:
        return
    for lists in (scope.names, scope.units):
        stray = [x for x in lists if x.of and x.of not in scope.known]
        sizes = Counter(len(x.lines) for x in stray)
        for x in stray:
            fits = [
                path.rsplit("/", 1)[-1]
                for path, node in scope.matrices
                if len(x.lines) in (node.rows, node.columns) and not _is_listed(lists, path)
            ]
            lists.remove(x)
            if len(fits) == 1 and sizes[len(x.lines)] == 1:
                lists.append(replace(x, of=fits[0]))
            elif fits:
                plan.notes.append(
                    f"'{x.called}' may be of {' or '.join(fits)}: not used; call it {fits[0]}_names, say"
                    if len(fits) > 1
                    else f"'{x.called}' is one of {sizes[len(x.lines)]} lists for {fits[0]}: not used"
                )


def _is_listed(lists: list[Listed], path: str) -> bool:
    return any(x.of == path.rsplit("/", 1)[-1] for x in lists)


def fitting(scope: Scope, kind: str, count: int, path: str) -> list[str] | None:
    """Of the lists of `kind` (names, units) with as many entries as a matrix has columns, the one that is called after
    it or a struct around it, else the nearest that is called after none; None: there is none. path: the matrix."""
    lists: list[Listed] = [x for s in upwards(scope) for x in getattr(s, kind) if len(x.lines) == count]
    around = path.split("/")
    own = next((x for x in lists if x.of in around), None) or next((x for x in lists if _of_any(scope, x)), None)
    return None if own is None else list(own.lines)


def _of_any(scope: Scope, listed: Listed) -> bool:
    return not listed.of or all(listed.of not in level.known for level in upwards(scope))


def unit_of(scope: Scope, path: str) -> str | None:
    """The one unit that is said of a matrix as a whole: T_unit of T."""
    name = path.rsplit("/", 1)[-1]
    return next((u for s in upwards(scope) if (u := s.unit_of.get(name))), None)


def scales_of(scope: Scope, count: int, path: str) -> list[dict[str, str]]:
    """Of each column of a matrix, the factors and offsets that vectors of as many numbers state: {'gain': '0.1'}."""
    around = ("", *path.split("/"))
    lists = [x for s in upwards(scope) for x in s.scales if len(x.lines) == count and x.of in around]
    return [{x.called: x.lines[i] for x in reversed(lists)} for i in range(count)]
