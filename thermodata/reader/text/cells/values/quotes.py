"""What stands around a cell of a text: blanks, quotes, a stray mark."""

from __future__ import annotations

import re

_QUOTED_PARTS = re.compile(r'"[^"]+"(?:\[[^\]"]*\])?(?:\."[^"]+"(?:\[[^\]"]*\])?)+')


def clean(cell: str) -> str:
    """A cell without blanks, quotes and a stray byte order mark around it. A quote alone stays: it is no empty cell;
    and so do those of its parts."""
    if cell and cell[0] > '"' < cell[-1] and cell.isascii():  # nearly every cell; blanks and quotes come before
        return cell
    text = cell.strip().strip("\ufeff").strip()
    bare = text.strip('"').strip()
    return _without_outer_quotes(text) if '"' in bare else bare or '"' * (text.count('"') % 2)


def _without_outer_quotes(text: str) -> str:
    """A cell that holds quotes: where they are of its parts ('ns=3;s="DB"."T01"') they stay, at both ends too."""
    if _QUOTED_PARTS.fullmatch(text):
        return text
    if text[0] == '"' == text[-1]:
        return text[1:-1].replace('""', '"').strip()
    return text.strip('"').strip() if text.count('"') % 2 else text
