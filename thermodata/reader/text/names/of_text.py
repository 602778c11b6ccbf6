"""Columns that are called after words: comments, messages, alarms. What stands in a few of their rows is no time."""

from __future__ import annotations

import re

OF_TEXT = re.compile(r"(?i)comment|note|alarm|message|text|label|remark|bemerk|kommentar|meldung|pozn|hinweis")
