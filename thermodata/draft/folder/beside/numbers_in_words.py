"""Numbers that a note writes out before a length of time: 'two minutes', 'vierzig Sekunden', 'une heure'."""

from __future__ import annotations

import re

_WORDS = {
    0.5: "half half-an halbe halben demi mezza media půl pul",
    1: "one a an ein eine einer einem une un una uno jedna jednu jednou",
    2: "two zwei deux due dos dva dvě dve",
    3: "three drei trois tre tres tři tri",
    4: "four vier quatre quattro cuatro čtyři ctyri",
    5: "five fünf fuenf cinq cinque cinco pět pet",
    6: "six sechs sei seis šest sest",
    7: "seven sieben sept sette siete sedm",
    8: "eight acht huit otto ocho osm",
    9: "nine neun neuf nove nueve devět devet",
    10: "ten zehn dix dieci diez deset",
    12: "twelve zwölf zwoelf douze dodici doce dvanáct dvanact",
    15: "fifteen fünfzehn fuenfzehn quinze quindici quince patnáct patnact",
    20: "twenty zwanzig vingt venti veinte dvacet",
    30: "thirty dreißig dreissig trente trenta treinta třicet tricet",
    40: "forty fourty vierzig quarante quaranta cuarenta čtyřicet ctyricet",
    45: "forty-five fünfundvierzig fuenfundvierzig quarante-cinq quarantacinque",
    50: "fifty fünfzig fuenfzig cinquante cinquanta cincuenta padesát padesat",
    60: "sixty sechzig soixante sessanta sesenta šedesát sedesat",
}
_VALUE = {word: value for value, spelt in _WORDS.items() for word in spelt.split()}
_LENGTH = r"(?:s\b|sec|sek|second|segund|min|h\b|hour|stunde|heure|or[ae]\b|hodin|vteřin)"
_ANY = "|".join(sorted(map(re.escape, _VALUE), key=len, reverse=True))
_FOUND = re.compile(
    rf"(?<![\w-])(?P<word>half\s+an?|eine?r?\s+halben?|{_ANY})(?=\s+{_LENGTH})",
    re.IGNORECASE,
)


def in_digits(sentence: str) -> str:
    """The sentence with '2' for 'two' before a length of time; a word before anything else stays."""

    def digits(found: re.Match[str]) -> str:
        word = found["word"].casefold()
        return "0,5" if "hal" in word else f"{_VALUE[word]:g}".replace(".", ",")  # a dot would end the sentence

    return _FOUND.sub(digits, sentence)
