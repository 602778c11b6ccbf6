"""One table as text, Markdown, CSV or LaTeX: for the terminal, a repository, a spreadsheet, a paper."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from thermodata.report.text.table import Column, cell, table

_LATEX = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "|": r"\textbar{}",  # a dash in the oldest and commonest encoding of fonts
    "<": r"\textless{}",
    ">": r"\textgreater{}",
}


def markdown(rows: Sequence[Mapping[str, Any]], columns: Iterable[Column]) -> str:
    """A table of Markdown; numbers to the right."""
    columns = list(columns)
    heads = [heading or " " for _, heading in columns]
    rule = ["---:" if _numbers(rows, key) else "---" for key, _ in columns]
    lines = [heads, rule, *([cell(row.get(key)) for key, _ in columns] for row in rows)]
    return "\n".join("| " + " | ".join(text.replace("|", "\\|") for text in line) + " |" for line in lines)


def comma_separated(rows: Sequence[Mapping[str, Any]], columns: Iterable[Column]) -> str:
    """CSV with every digit; nothing where there is no value."""
    columns = list(columns)
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([heading for _, heading in columns])
    for row in rows:
        values = [row.get(key) for key, _ in columns]
        writer.writerow(["" if v is None else repr(v) if isinstance(v, float) else v for v in values])
    return out.getvalue().rstrip("\n")


def latex(rows: Sequence[Mapping[str, Any]], columns: Iterable[Column]) -> str:
    """A tabular with rules of booktabs."""
    columns = list(columns)
    align = "".join("r" if _numbers(rows, key) else "l" for key, _ in columns)
    lines = [" & ".join(_escaped(heading) for _, heading in columns) + r" \\"]
    body = [" & ".join(_escaped(cell(row.get(key))) for key, _ in columns) + r" \\" for row in rows]
    return "\n".join(
        [rf"\begin{{tabular}}{{{align}}}", r"\toprule", *lines, r"\midrule", *body, r"\bottomrule", r"\end{tabular}"]
    )


LAYOUTS: dict[str, Callable[[Sequence[Mapping[str, Any]], Iterable[Column]], str]] = {
    "text": table,
    "markdown": markdown,
    "csv": comma_separated,
    "latex": latex,
}


def _numbers(rows: Sequence[Mapping[str, Any]], key: str) -> bool:
    values = [row.get(key) for row in rows if row.get(key) is not None]
    return bool(values) and all(isinstance(v, int | float) and not isinstance(v, bool) for v in values)


def _escaped(text: str) -> str:
    return "".join(_LATEX.get(char, char) for char in text)
