"""A sentence of several figures, a clause a line: seven lines in one are read by nobody."""

from __future__ import annotations


def clauses(sentence: str) -> list[str]:
    """What semicolons part; those within brackets stay where they are, and so does a bracket that never closes."""
    parts, depth, start = list[str](), 0, 0
    for at, char in enumerate(sentence):
        depth = max(0, depth + (char in "([") - (char in ")]"))
        if depth == 0 and sentence.startswith("; ", at):
            parts.append(sentence[start:at])
            start = at + 2
    return [*parts, sentence[start:]]


def in_lines(sentence: str) -> str:
    """The first clause, and each further one in a line of its own below it, put in by two."""
    return "\n  ".join(clauses(sentence))
