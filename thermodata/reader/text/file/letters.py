"""Whether letters with diacritics are those of Western or of Central Europe, by the letters that stand beside them.

One byte is è in cp1252 and č in cp1250. A word tells: è stands between consonants ('pièce'), č beside vowels
('otáčky'). What stands beside which is learned from words that logs of machine tools hold.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator
from functools import cache

# French, Italian, Spanish, Portuguese, Catalan, Danish, Norwegian, Swedish
_WESTERN = """
arrière derrière pièce pièces première dernière lumière matière poussière glissière chaudière crémaillère rivière
molette système systèmes modèle problème troisième deuxième extrême diamètre paramètre périmètre mètre thermomètre
manomètre fenêtre tête têtes arrêt arrêté arrêts même être prêt fête règle règles réglé mèche arête crête côté débit
accès après très près succès procès espèce fièvre légère chère manière filière chargère entière bière barrière carrière
à là déjà voilà çà où dû sûr sûreté août coût brûleur goût mûr sûre flûte hélicoïdal hélicoïdale maïs naïf égoïste
œil œuvre cœur nœud manœuvre bœuf sœur vœu levée élève relève élevé sèche sécheresse lèvre fèvre chèvre zèle sévère
repère repères caractère critère cylindrée galère atmosphère sphère hémisphère ampère ampères générère mère père
température moyenne règlement siège piège collège manège allège complète discrète secrète planète étanchéité bête
velocità qualità umidità attività unità capacità intensità linearità metà età libertà viscosità densità conducibilità
proprietà quantità già città elettricità rigidità stabilità modalità priorità estremità profondità validità à
è cioè caffè perché finché più giù virtù può però così lunedì martedì mercoledì giovedì venerdì lì sì ciò andrà sarà
avrà verrà farà darà potrà portò arrivò misurò
señal señales tamaño año años diseño daño dueño cañón caña mañana España español compañía pequeño pequeña baño montaña
enseñanza otoño leña puño niño cuña cuñas muñón ñ
rotação rotações posição posições refrigeração vibração lubrificação medição medições variação compensação pressão
tensão avaliação razão mão não são então ligação operação direção fundação aceleração expansão dilatação fração
válvulas câmera pães mães limitações tensões pressões dimensões razões três você às àquele estação usinagem padrão
alimentação calibração correção deformação ambiência avanço mudança fixação sessão
måling måle måler måned må målt måle hånd både båd gård skål stål stålplade påbegynt på nå således tråd spåner våd
kjøling kjølevann kølevand køling kølemiddel kjøl føler følere bøjning høyre højre høj høyde hjørne kørsel kjøring
støt før før større øverst øvre nederst tørr tør sø grøn støj ø lås måte
måling læs læse længde lære væske væskes bevægelse mæssig næste temperaturmåling værktøj emne værdi værdier
nivå åter från två också spår måste råd tråd låda spindellåda hållare hålla uppmätt mått matningsåt gång båge ström
"""
# Czech, Slovak, Polish, Hungarian, Croatian and Slovene, Romanian
_CENTRAL = """
čas časy čidlo čidla číslo čelo čelní čelist čep čepu čerpadlo čerpadla čtení čtvrtý částice část části činnost
otáčky otáček počet početní tlačítko tlačný točna otočný otočná otočného snímač snímače snímač vřeteno vřetene vřetena
vřeteník přední zadní přívod přívodní převod převodovka převodovky příčník příčka řemen řízení řezání řezný řez měření
měřič měřicí měřený měřidlo teploměr průměr průtok průtoku průběh průhyb směr směru směs síť těleso těsnění stěna
dělička závěr závěs zpětná zpět pět dvěře dveře hladině teplotě době světlo květen objem motorů strojů stůl stolu důl
vůle vůz kůže způsob původ hodnoty dolů nahoru plošně ručně vnitřní vnější vnějšek uvnitř střed středu střední stříška
tři dřík křížový kříž koleček klička spojka ložisek uchycení tlumič ventilátor výměník vyměň výkon zapnuto ohřev
ohřívač chladič chladiče chlazení rozdíl žluťoučký kůň skříň rozvaděč rozváděč hřídel řádek řada teplý nástrojů běh
běží sběr počátek konečný začátek konec klíč kotouč kotouče tyč tyče dotyk skluz plášť plášťě zátěž zatížení něco
snímačů kotoučů uhlíků ventilů kanálů dílů bodů testů nožů válců sloupů článků pohonů prvků údajů řezů průtoků
teplotě hodnotě hlavě místě stopě straně vodě ploše pouzdře komoře desce ověření ověřeno olověný dřevěný skleněná
kleština čelisti výstředník předehřev předehřátí točivý proměnná měnič měniče změna změny výměna záměna něm
loďka ďáble teď síť šířka tloušťka skleněný přesnost přesný zpráva předpětí příkon příruba posuv převodník řídicí
saně suport vodicí poloha příklad přímka lože smykadlo matice šroubu šroub svislý vodorovný výška délka chybějící
teplota vretena otáčky vreteník vŕtanie vŕtačka stĺp stĺpa stĺpik tĺk kĺb ľavý ľavá voľný poľa chvíľa nádrž dĺžka
vonkajšia chladiaca kvapalina prúd skriňa výkon počet tŕň spätná čistenie vačka
łożysko łożyska łożysk przednie tylne wrzeciono wrzeciona prędkość prędkości obrotowa położenie położenia osłona stół
stołu ciśnienie ciśnienia przepływ przepływu zasilanie chłodziwo chłodziwa chłodzenie chłodnica chłodzący smarowanie
śruba śruby środek środkowy ściana ściany świeże głowica głowicy kolumna łoże łoża prąd prądu moc wejście wejściowa
wyjście wyjściowa długość wysokość szerokość głębokość częstotliwość napięcie napięcia natężenie nakrętka nakrętki
prowadnica powietrze górna dół dolna tylna zewnętrzna wewnętrzna wewnątrz zewnątrz różnica obciążenie obciążenia
wrzecionie dźwignia źródło żarówka żeliwo łączny łącznik łańcuch włączony wyłączony wyłącznik wał wału wałek wałka
ręczny ręcznie pętla błąd błędu część części ćwierć jakość wilgotność wartość wartości gęstość lepkość ilość być
stopień stopni dzień tydzień kwiecień grudzień sień końcówka koniec końca wykończenie kończyć żądany żądana położeń
narzędzie narzędzia oś osi osią pomiarów przesunięcie przesunięcia odkształcenie wydłużenie przedmiot uchwyt zbiornik
sprężone sprężarka temperaturę moment pokrętło przekładnia przełącznik świetlny spręż siła silnik silnika mgła mgły
wnętrze wnętrza wewnętrzny zewnętrzny ręka ręki węgiel sprzęt sprzęgło pręt pręta zęby wręby szczęki kręcić płyn płyta
hőmérséklet hőmérséklete hőmérő hűtő hűtővíz hűtőfolyadék hűtés hűtött fűtés fűtő fő főorsó főtengely előtolás elülső
idő időbélyeg levegő külső belső felső alsó hátsó első második erő erőmérő mérő mérés gyűrű műhely működés művelet
szélesség sűrűség szűrő szűrés cső csővezeték szivattyú működik gőz nyomás idők időszak tükör előre előfeszítés közepső
vezető vezetősín tető ütköző szenzor különbség nő lévő levő műszer mű tűrés következő kezdő
ležaj brzina vretena površina točka početak kućište čahura tlačni mjerač osovina vođenje rashlađivanje srednji
ćelija moć voće već noć veći veličina kočnica pomaćnuto količina naprežanje dovođenje đubre između također
viteză presiune lagăr masă apă ulei pompă temperatură axă faţă mişcă răcire răcitor motor putere îndepărtată până după
fără cădere rămas încălzire călire bară tijă sculă piesă ramă cutie ţară ţeavă viteţă poziţie poziţia rotaţie staţie
uşă şurub şină faţă acţionare
"""
# letters of either that stand elsewhere in the other
_DIFFERING = frozenset(
    b for b in range(0x80, 0x100) if bytes((b,)).decode("cp1250", "ignore") != bytes((b,)).decode("cp1252", "ignore")
)
_LETTERS = frozenset(b"abcdefghijklmnopqrstuvwxyz") | {
    *(b for b in (*range(0x9A, 0xA0), 0xB3, 0xB9, 0xBA, 0xBE, 0xBF, *range(0xDF, 0x100)) if b != 0xF7)
}
_LOWER = bytes.maketrans(
    bytes(
        (*range(0x41, 0x5B), *range(0x8A, 0x90), 0xA3, 0xA5, 0xAA, 0xAF, 0xBC, *range(0xC0, 0xD7), *range(0xD8, 0xDF))
    ),
    bytes(
        (*range(0x61, 0x7B), *range(0x9A, 0xA0), 0xB3, 0xB9, 0xBA, 0xBF, 0xBE, *range(0xE0, 0xF7), *range(0xF8, 0xFF))
    ),
)
_SPAN = 24  # letters of a word that are looked at, to either side
_MOST = 20_000  # letters that are looked at in a file
_WORD_LIMIT = 4.0  # what one word may say, in natural logarithms of odds
_UNSEEN = 0.02  # the share of what was never seen beside a letter
_UNPROVEN = 1.0  # what a whole file must say, in the same
# what is no letter there: powers, ordinal marks (Nº, Tª), °C with the mark of an ordinal, fractions
_SIGNS = re.compile(
    rb"(?<![\x80-\xff])(?:k?[cm]?m|s)[\xb2\xb3\xb9](?![A-Za-z\x80-\xff])|\xba[CFK](?![a-z])|[nN1-9]\xba"
    rb"|(?<![A-Za-z])T\xaa(?![a-z])|\d[\xbc-\xbe](?![A-Za-z])|\xbf(?=[A-Z])|(?<![A-Za-z])\xb2"
)

Table = dict[tuple[int, str, bytes], int]


def _letter_with_neighbours(word: bytes) -> Iterator[tuple[int, tuple[tuple[str, bytes], ...]]]:
    """(letter, what stands beside it) of each differing letter of a word in small letters."""
    padded = b"__" + word + b"__"
    for at, letter in enumerate(padded):
        if letter in _DIFFERING:
            before, after = padded[at - 2 : at], padded[at + 1 : at + 3]
            yield (
                letter,
                (("<<", before), ("<", before[1:]), (">", after[:1]), (">>", after), ("<>", before[1:] + after[:1])),
            )


@cache
def _learned() -> tuple[Table, Table]:
    """How often which letters stand beside which, in words of Western and of Central Europe."""
    tables: list[Table] = []
    for words, encoding in ((_WESTERN, "cp1252"), (_CENTRAL, "cp1250")):
        seen: Counter[tuple[int, str, bytes]] = Counter()
        for word in sorted(set(words.split())):
            seen[0, "word", word.encode(encoding)] = 1
            for letter, beside in _letter_with_neighbours(word.encode(encoding)):
                seen.update((letter, where, text) for where, text in (("", b""), *beside))
        tables.append(dict(seen))
    return tables[0], tables[1]


def _word(word: bytes) -> float:
    """How much more a word in small letters is of Western than of Central Europe, in logarithms of odds."""
    if len(word) == 1 and word != b"\xe0":
        return 0.0  # 'è' alone and 'č. 3' are as usual; 'à' is one word only
    western, central = _learned()
    total = 2 * _WORD_LIMIT * ((0, "word", word) in western) - 2 * _WORD_LIMIT * ((0, "word", word) in central)
    for letter, beside in _letter_with_neighbours(word):
        of_west, of_east = western.get((letter, "", b""), 0), central.get((letter, "", b""), 0)
        if not (of_west and of_east):  # a letter of one side only, as \xb9 within a word
            total += _WORD_LIMIT * (bool(of_west) - bool(of_east))
            continue
        total += 0.5 * math.log(of_west / of_east)
        for where, text in beside:
            here = western.get((letter, where, text), 0) / of_west
            there = central.get((letter, where, text), 0) / of_east
            total += 0.6 * math.log((here + _UNSEEN) / (there + _UNSEEN))
    return max(-_WORD_LIMIT, min(_WORD_LIMIT, total))


def _words(data: bytes) -> dict[bytes, bytes]:
    """The words that hold a differing letter: in small letters -> as they stand. Long ones are cut."""
    found: dict[bytes, bytes] = {}
    end, lower = 0, data.translate(_LOWER)
    for number, hit in enumerate(_HIGH.finditer(lower)):
        at = hit.start()
        if number == _MOST:
            break
        if at < end:
            continue
        first = at
        while first > max(0, at - _SPAN) and lower[first - 1] in _LETTERS:
            first -= 1
        end = at + 1
        while end < min(len(lower), at + _SPAN) and lower[end] in _LETTERS:
            end += 1
        found.setdefault(lower[first:end], data[first:end])
    return found


_HIGH = re.compile(b"[" + b"".join(re.escape(bytes((b,))) for b in sorted(_DIFFERING & _LETTERS)) + b"]")


def western_not_central(data: bytes) -> tuple[float, bytes | None]:
    """(above 0 for cp1252, below 0 for cp1250, 0 where it can't be told; a word that tells least, or None where no
    letter differs)."""
    signs = len(_SIGNS.findall(data))
    words = _words(_SIGNS.sub(b" ", data) if signs else data)
    said = {shown: _word(small) for small, shown in words.items()}
    total = sum(said.values()) + 3.0 * min(signs, 3)
    least = min(said, key=lambda w: abs(said[w])) if said else None
    return (total if abs(total) >= _UNPROVEN else 0.0), least
