"""What every answer has: a text for a terminal, and the same as HTML for a notebook."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

from thermodata.report.text.table import Column, cell, table
from thermodata.report.words.numbers import typeset

if TYPE_CHECKING:
    import pandas as pd


class Shown(ABC):
    """Its `repr` is `summary()`; in a notebook the same stands in tables."""

    @abstractmethod
    def summary(self) -> str:
        """For a person, in plain text."""

    def html(self) -> str:
        """For a notebook."""
        return f"<pre>{escape(self.summary())}</pre>"

    def __repr__(self) -> str:
        return self.summary()

    def _repr_html_(self) -> str:
        return self.html()


class Listed(Shown, Sequence[dict[str, Any]]):
    """Rows as the command's --json has them, shown in the command's columns. shown: the rows of the command's table,
    where these are others."""

    def __init__(
        self,
        rows: Iterable[Mapping[str, Any]],
        columns: Iterable[Column],
        title: str = "",
        shown: Sequence[Mapping[str, Any]] | None = None,
    ) -> None:
        self.rows, self.columns, self.title = [dict(row) for row in rows], list(columns), title
        self._shown = self.rows if shown is None else shown

    def __getitem__(self, index: Any) -> Any:
        return self.rows[index]

    def __len__(self) -> int:
        return len(self.rows)

    def df(self) -> pd.DataFrame:
        """All keys as pandas."""
        import pandas

        return pandas.DataFrame(self.rows)

    def summary(self) -> str:
        text = table(self._shown, self.columns)
        return f"{self.title}\n\n{text}" if self.title else text

    def html(self) -> str:
        return html_table(self._shown, self.columns, self.title)


def html_table(rows: Sequence[Mapping[str, Any]], columns: Iterable[Column], title: str = "") -> str:
    """A table of values; texts are escaped, numbers stand to the right."""
    columns = list(columns)
    head = "".join(f"<th>{escape(typeset(heading))}</th>" for _, heading in columns)
    body = "".join("<tr>" + "".join(_cell(row.get(key)) for key, _ in columns) + "</tr>" for row in rows)
    caption = f"<caption>{escape(title)}</caption>" if title else ""
    return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _cell(value: Any) -> str:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    text = escape(typeset(cell(value)))
    return f'<td style="text-align:{"right" if number else "left"}">{text}</td>'
