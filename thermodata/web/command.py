"""The command that does what a page does, as it is typed."""

from __future__ import annotations

import shlex
from pathlib import Path

from thermodata.web.desk import DEFAULT_STORE


def command(store: Path, *words: str | Path) -> str:
    """'thermodata tests -c gantry'; names the store where it is not the one that a terminal would take."""
    named = [] if store == Path.cwd() / DEFAULT_STORE else ["--store", str(store)]
    return " ".join(_quoted(w) for w in ["thermodata", *named, *(str(w) for w in words)])


def _quoted(word: str) -> str:
    """As a shell takes it. What has quotes of its own, as queries do, stands in double ones, where that hides nothing
    from the shell: each quote of `shlex` would be five characters."""
    return f'"{word}"' if "'" in word and not _MEANT.intersection(word) else shlex.quote(word)


_MEANT = set('"$`\\!')  # what a shell takes for its own within double quotes; '!' where it keeps a history
