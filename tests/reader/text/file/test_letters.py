"""cp1250 or cp1252: the words of a log tell, whichever language it is in; where they don't, it is asked."""

from __future__ import annotations

import pytest

from thermodata.errors import FormatError
from thermodata.reader.text import decode, decode_head
from thermodata.reader.text.file.encoding import find_encoding

WESTERN = {
    "French": "Pièce Entrée Poupée Température Palier.arrière Glissière.Z Écrou.Y Bâti Extérieur "
    "Groupe.froid.départ Débit Système Crémaillère.gauche Arrêt Tête Vérin Règle.X Diamètre Chaîne.porte-câbles "
    "Poussières",
    "Italian": "Velocità Umidità Attività Cuscinetto Mandrino Montante Basamento Potenza Aria Unità "
    "Avanzamento Velocità.mandrino Umidità.capannone Densità.olio Quantità",
    "Spanish": "Señal Año Tamaño Husillo Presión Refrigeración Caña Bancada Posición Vibración "
    "Temperatura.extraña Señal.posición Muñón Diseño Husillo.pequeño",
    "German": "Spindel Ständer Führung Außen Kühlmittel Öl Wärme Behälter Gehäuse Lüfter Größe Türkontakt "
    "Rückwand Stößel",
    "Portuguese": "Rotação Posição Vibração Pressão Refrigeração Óleo Câmara Vazão Lubrificação Tensão "
    "Medições Rotações Mancal Fundação",
    "Danish and Norwegian": "Måling Kjøling Kølevand Føler Højre Høyre Nivå Værktøj Spåner Lås Omdrejning Kølemiddel",
}
CENTRAL = {
    "Czech": "Čas Otáčky Vřeteno Ložisko.přední Příkon Chladič Průtok Čidlo Převodovka Snímač Stůl Těleso "
    "Šroub Řemen Kůň Rozváděč Sloup.střed Mazání",
    "Slovak": "Čas Otáčky Vreteno Ložisko Snímač Vŕtanie Ľavý.stĺp Čerpadlo Počet Vačka Chladič.oleja "
    "Prevodovka.zvyšok",
    "Polish": "Łożysko Wrzeciono Prędkość Położenie Ciśnienie Przepływ Chłodziwo Stół Śruba Wejście Napięcie "
    "Prąd Nakrętka Obciążenie Wałek Długość",
    "Hungarian": "Hőmérséklet Hűtő Előtolás Főorsó Külső Felső Levegő Idő Erő Fűtés Gyűrű Műhely Szűrő "
    "Elülső Csapágy Nyomás",
}
CASES = [(name, w, "cp1252") for name, w in WESTERN.items()] + [(name, w, "cp1250") for name, w in CENTRAL.items()]


@pytest.mark.parametrize(("words", "encoding"), [(w, e) for _, w, e in CASES], ids=[name for name, _, _ in CASES])
@pytest.mark.parametrize("case", [str, str.upper, str.lower])
def test_each_word_of_a_log_is_read_as_it_was_written(words: str, encoding: str, case: object) -> None:
    listed = [case(w.replace(".", " ")) for w in words.split()]  # type: ignore[operator]
    assert len(listed) >= 12
    for text in (";".join(f"{w} [°C]" for w in listed), *(f"{w} [°C]" for w in listed)):
        assert decode(text.encode(encoding))[0] == text
        assert decode_head(text.encode(encoding)) == text


def test_a_unit_with_a_power_does_not_make_a_log_western_that_is_none() -> None:
    text = "Čas;Průtok přední [l/min];Výkon čerpadla [W];Otáčky vřetena"
    assert decode(text.encode("cp1250") + b";q [W/m2]")[0].startswith(text)
    for one in ("q [W/m²]", "V [m³/h]", "a [m/s²]", "T [ºC]", "Nº 4", "Tª columna"):
        assert decode(one.encode("cp1252"))[0] == one
    assert decode(b"q [W/m\xb2];V [m\xb3/h];T [\xbaC]")[0] == "q [W/m²];V [m³/h];T [ºC]"


def test_a_letter_that_may_be_either_is_asked() -> None:
    with pytest.raises(FormatError, match="does not name") as caught:
        decode(b"T \xe8 [V]")
    assert "cp1252: 'è'; cp1250: 'č'" in str(caught.value)
    assert "declare the source's encoding: cp1252" in str(caught.value)
    for weak in (b"T d\xf2n", b"T k\xf2n", b"t\xe8k"):  # no word that is known, nor letters as they stand in one
        with pytest.raises(FormatError, match="does not name"):
            decode(weak)
    assert decode(b"T \xe8 [V]", "cp1250")[0] == "T č [V]"


def test_a_long_word_of_such_letters_takes_no_longer_than_others() -> None:
    """Nothing but these letters, a megabyte of them: each piece is looked at once."""
    data = b"T;" + b"ab\xe8re" * 200_000
    assert decode_head(data) is not None


def test_what_both_write_alike_is_read_as_western() -> None:
    """German letters and degrees are one in both: no German is told that his log is read as Central European."""
    encoding, note = find_encoding("Zeit;Kühlaggregat [°C];Führung [µm]\n".encode("cp1252"))
    assert encoding == "cp1252"
    assert note is not None
    assert "cp1250" not in note
