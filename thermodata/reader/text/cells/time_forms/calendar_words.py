"""Months and weekdays as the languages of labs write them, and dates that hold such words: '4. Mai 2026'."""

from __future__ import annotations

import calendar
import re
import unicodedata
from functools import lru_cache

_MONTHS = (
    "january jan januar janner janvier janv gennaio gen enero ene janeiro leden ledna stycznia styczen januari januara",
    "february feb februar feber fevrier fevr fev febbraio febrero fevereiro unor unora lutego luty februari februara",
    "march mar marz maerz mrz mars marzo marco brezen brezna marca marzec maart mrt marts marcius",
    "april apr avril avr aprile abril abr duben dubna kwietnia kwiecien aprila aprilis",
    "may mai maggio mag mayo maio kveten kvetna maja maj mei majus",
    "june jun juni juin giugno giu junio junho cerven cervna czerwca czerwiec juna junius",
    "july jul juli juillet juil luglio lug julio julho cervenec cervence lipca lipiec jula julius",
    "august aug aout agosto ago srpen srpna sierpnia sierpien augustus augusti augusta augusztus",
    "september sep sept septembre settembre sett septiembre setiembre setembro zari wrzesnia wrzesien septembra "
    "szeptember",
    "october oct oktober okt octobre ottobre ott octubre outubro rijen rijna pazdziernika pazdziernik oktobra",
    "november nov novembre noviembre novembro listopad listopadu listopada novembra",
    "december dec dezember dez decembre dicembre dic diciembre dezembro prosinec prosince grudnia grudzien "
    "desember decembra",
)
MONTH = {word: number for number, words in enumerate(_MONTHS, 1) for word in words.split()}
# what programs put into cells: too short to be told from other words in a sentence
_IN_CELLS = (
    "led sty",
    "uno lut",
    "bre brz",
    "dub kwi",
    "kve mag",
    "cvn cze",
    "cvc lip",
    "srp sie",
    "zar wrz",
    "rij paz",
    "lis",
    "pro gru",
)
WEEKDAYS = (
    "monday tuesday wednesday thursday friday saturday sunday mon tue tues wed thu thur thurs fri sat sun "
    "montag dienstag mittwoch donnerstag freitag samstag sonnabend sonntag mo di mi do fr sa so "
    "lundi mardi mercredi jeudi vendredi samedi dimanche lun mar mer jeu ven sam dim "
    "lunedi martedi mercoledi giovedi venerdi sabato domenica gio sab dom "
    "lunes martes miercoles jueves viernes sabado domingo mie jue vie segunda terca quarta quinta sexta feira "
    "pondeli utery streda ctvrtek patek sobota nedele po ut st ct pa ne "
    "poniedzialek wtorek sroda czwartek piatek niedziela pon wt sr czw pt sob nd niedz "
    "maandag dinsdag woensdag donderdag vrijdag zaterdag zondag ma wo vr za zo "
    "mandag tirsdag onsdag torsdag fredag lordag sondag tisdag tir ons tor fre lor son "
    "martedì mercoledì giovedì venerdì miércoles sábado mié sáb terça úterý středa čtvrtek pátek neděle środa "
    "hetfo kedd szerda csutortok pentek szombat vasarnap"
)  # as people write them, and without diacritics
_FOLDED = str.maketrans({"ø": "o", "ł": "l", "æ": "ae", "'": "", "’": ""})
_MONTHS_OF_CELLS = MONTH | {word: number for number, words in enumerate(_IN_CELLS, 1) for word in words.split()}
_DAYS_OF_CELLS = frozenset(WEEKDAYS.split())
_WORD = re.compile(r"([^\W\d_]+)(\.?)")
_LETTERS = re.compile(r"%([aAbB])(\.?)")
_DAY_AND_YEAR = re.compile(
    r"(?<!\d)\d{1,2}(?!\d).*(?<!\d)(?:\d{4}|\d\d)(?!\d)|(?<!\d)\d{4}(?!\d).*(?<!\d)\d{1,2}(?!\d)"
)


@lru_cache(maxsize=4096)
def folded(text: str) -> str:
    """A text in small letters without diacritics."""
    parts = unicodedata.normalize("NFD", text.casefold().translate(_FOLDED))
    return "".join(c for c in parts if not unicodedata.combining(c))


def letters_of(words: list[str]) -> list[str | None]:
    """strptime's letters for each word of a cell: `%b` of a month, `%B` where English writes it out, `%a` of a weekday;
    None of others. A word that is both ('mar', mardi and marzo) is a weekday before a month."""
    bare = [folded(w) for w in words]
    months = [w in _MONTHS_OF_CELLS for w in bare]
    found: list[str | None] = []
    for k, word in enumerate(bare):
        if word in _DAYS_OF_CELLS and (not months[k] or any(months[k + 1 :])):
            found.append("%A" if word.title() in calendar.day_name else "%a")
        elif months[k]:
            found.append("%B" if word.title() in calendar.month_name and word != "may" else "%b")
        else:
            found.append(None)
    return found


def is_worded_date(cell: str) -> bool:
    """Whether a text holds one month by its name, a day and a year, and no other words but a weekday and those between
    them: '4. Mai 2026', 'Mo, 4 de maio de 2026'."""
    words = _WORD.findall(cell)
    if not words or len(words) > 5 or len(cell) > 40 or _DAY_AND_YEAR.search(cell) is None:
        return False
    letters = letters_of([word for word, _ in words])
    months = sum(found in ("%b", "%B") for found in letters)
    others = [word for (word, _), found in zip(words, letters, strict=True) if found is None]
    return months == 1 and all(folded(word) in ("de", "of", "the", "th", "st", "nd", "rd", "del") for word in others)


def in_english(cell: str, form: str) -> tuple[str, str]:
    """(cell, form) with the words of the cell for which the form, in strptime's letters, has names of months and
    weekdays, as strptime reads them, and without the dots of abbreviations: ('04 May 2026', '%d %b %Y') of
    ('04 Mai. 2026', '%d %b. %Y'). A weekday is any: nothing is read from it."""
    wanted = [match[1] for match in _LETTERS.finditer(form)]
    if not wanted:
        return cell, form

    def spelled(match: re.Match[str]) -> str:
        if not wanted:
            return match[0]
        letter, word = wanted[0], folded(match[1])
        if letter in "aA" and word in _DAYS_OF_CELLS:
            wanted.pop(0)
            return (calendar.day_abbr if letter == "a" else calendar.day_name)[0]
        if letter in "bB" and (month := _MONTHS_OF_CELLS.get(word)) is not None:
            wanted.pop(0)
            return (calendar.month_abbr if letter == "b" else calendar.month_name)[month]
        return match[0]

    return _WORD.sub(spelled, cell), _LETTERS.sub(lambda match: f"%{match[1]}", form)
