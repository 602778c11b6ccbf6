"""What loggers write into a cell where they have no value, in lower case: nothing, or a reading beyond their range."""

from __future__ import annotations

from functools import lru_cache

# what a display shows for a sensor that is not there: '-.-', '--.--', '-,--'
_DASHES = tuple("-" * n + mark + "-" * k for n in range(1, 5) for mark in ".," for k in range(1, 5))
EMPTY = frozenset(
    (
        *(
            "",
            *("-" * n for n in range(1, 13)),
            *_DASHES,
            "*",
            "***",
            "****",
            "?",
            "???",
            "null",
            "none",
            "unavailable",
        ),
        *("na", "n/a", "#n/a", "n.a.", "#nv", "nan", "+nan", "-nan", "nan(ind)", "-nan(ind)"),
        *("1.#qnan", "-1.#qnan", "1.#ind", "-1.#ind", "1,#qnan", "-1,#qnan", "1,#ind", "-1,#ind"),
    )
)
OVERLOAD = frozenset(
    (
        *("+" * n for n in range(3, 13)),
        *(sign + "f" * n for sign in "+-" for n in range(4, 9)),  # Keyence's heads: '+FFFFFFF'
        *(
            sign + word
            for sign in ("", "+", "-")
            for word in (
                *("ol", "ovl", "ovld", "ovr", "over", "overload", "overflow", "overrange", "over range"),
                *("burnout", "open tc"),
            )
        ),
    )
)


@lru_cache(maxsize=1)
def null_words() -> tuple[str, ...]:
    """`EMPTY` as a parser takes it that minds the case: as it stands, in capitals and as a title."""
    return tuple(
        sorted({form(word) for word in EMPTY for form in (str, str.upper, str.title, str.capitalize)} | {"NaN"})
    )
