"""Short words that count only beside another word of their own language, for they mean something else in others."""

from __future__ import annotations


def phrases(short: str, others: str) -> str:
    """Phrases of the vocabulary: each of the short words before and behind each of the others."""
    return " ".join(f"{s}~{o} {o}~{s}" for s in short.split() for o in others.split())
