"""What labs write in further languages, by the keys of the vocabulary; written as there (words/vocabulary.py).

Latin words that a name of another language could hold by chance carry the dot or the '^'. Cyrillic, kana and Hangul are
looked for anywhere. Diacritics may stand here or not: they are gone before matching.
"""

from __future__ import annotations

from collections.abc import Mapping

from thermodata.draft.words.languages import (
    dutch,
    french,
    hungarian,
    italian,
    japanese,
    korean,
    pinyin,
    polish,
    portuguese,
    romaji,
    russian,
    spanish,
    swedish,
    turkish,
)

# Czech and German stand with English in the vocabulary; what they lack stands in its words
LANGUAGES: tuple[Mapping[str, str], ...] = (
    japanese.WORDS,
    romaji.WORDS,
    pinyin.WORDS,
    korean.WORDS,
    french.WORDS,
    italian.WORDS,
    spanish.WORDS,
    portuguese.WORDS,
    polish.WORDS,
    russian.WORDS,
    turkish.WORDS,
    hungarian.WORDS,
    swedish.WORDS,
    dutch.WORDS,
)


def in_all_languages(key: str, own: str) -> str:
    """The words of a key: its own of the vocabulary, and those of every language here."""
    return " ".join([own, *(words[key] for words in LANGUAGES if key in words)])
