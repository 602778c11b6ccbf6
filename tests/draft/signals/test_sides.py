"""The sides of a part, as labs of many languages write them."""

from __future__ import annotations

import pytest

from thermodata.draft.signals.guess import guess

# language -> side of a column -> names of channels
SIDES = {
    "es": {
        "front": "Columna delante|Columna delantera|Lado delantero columna|Columna (parte anterior)",
        "rear": "Columna detrás|Columna trasera|Columna atrás|Columna posterior",
        "left": "Columna izquierda|Columna izq.|Columna izda.",
        "right": "Columna derecha|Columna dcha.|Columna dcho.",
        "top": "Columna arriba|Columna superior|Columna encima",
        "bottom": "Columna abajo|Columna inferior|Columna debajo",
    },
    "fr": {
        "front": "Colonne avant|Colonne devant|Montant AV",
        "rear": "Colonne arrière|Colonne derrière|Colonne arr.",
        "left": "Colonne gauche|Montant côté gauche",
        "right": "Colonne droite|Montant droit",
        "top": "Colonne haut|Colonne dessus|Colonne supérieure",
        "bottom": "Colonne bas|Colonne dessous|Colonne inférieure",
    },
    "it": {
        "front": "Colonna davanti|Colonna anteriore|Montanti anteriori|Colonna ant.",
        "rear": "Colonna dietro|Montanti posteriori|Colonna retro|Colonna post.",
        "left": "Colonna sinistra|Montante sinistro|Colonna sx",
        "right": "Colonna destra|Montanti destri|Colonna dx",
        "top": "Colonna in alto|Montanti superiori|Colonna sopra",
        "bottom": "Colonna in basso|Montanti inferiori|Colonna sotto",
    },
    "pt": {
        "front": "Coluna à frente|Coluna dianteira|Coluna anterior",
        "rear": "Coluna atrás|Coluna traseira|Coluna posterior",
        "left": "Coluna esquerda|Coluna lado esquerdo",
        "right": "Coluna direita|Coluna lado direito",
        "top": "Coluna em cima|Coluna topo|Coluna superior",
        "bottom": "Coluna em baixo|Coluna embaixo|Coluna inferior",
    },
    "cs": {
        "front": "Stojan vpředu|Sloup přední strana|Stojan zepředu",
        "rear": "Stojan vzadu|Stojan zadní|Stojan zezadu",
        "left": "Stojan vlevo|Stojan levý|Stojan nalevo",
        "right": "Stojan vpravo|Stojan pravá strana|Stojan napravo",
        "top": "Stojan nahoře|Stojan horní|Stojan shora",
        "bottom": "Stojan dole|Stojan spodní|Stojan zdola",
    },
    "pl": {
        "front": "Kolumna przód|Kolumna z przodu|Kolumna przednia",
        "rear": "Kolumna tył|Kolumna z tyłu|Temp. tylnej kolumny",
        "left": "Kolumna po lewej|Kolumna lewo",
        "right": "Kolumna po prawej|Kolumna prawo",
        "top": "Kolumna góra|Kolumna u góry",
        "bottom": "Kolumna dół|Kolumna u dołu",
    },
    "nl": {
        "front": "Kolom voor|Kolom voorzijde|Voorste kolom",
        "rear": "Kolom achter|Achterkant kolom",
        "left": "Kolom links|Linker kolom",
        "right": "Kolom rechts|Kolom rechterzijde",
        "top": "Kolom boven|Kolom bovenaan",
        "bottom": "Kolom onder|Onderste kolom",
    },
    "sv": {
        "front": "Pelare fram|Pelare främre|Pelare framtill",
        "rear": "Pelare bak|Pelare bakre|Pelare baksida",
        "left": "Pelare vänster|Vänstra pelaren",
        "right": "Pelare höger|Pelare högra",
        "top": "Pelare uppe|Pelare upptill",
        "bottom": "Pelare nere|Pelare nedtill",
    },
    "tr": {
        "front": "Kolon ön|Ön kolon|Sütun ön taraf",
        "rear": "Kolon arka|Kolon arkada",
        "left": "Kolon sol|Kolon solda",
        "right": "Kolon sağ|Kolon sağda",
        "top": "Kolon üst|Kolon üstte",
        "bottom": "Kolon alt|Kolon altta",
    },
    "de": {"front": "Säule vorne|Ständer Vorderseite", "rear": "Säule hinten|Ständer Rückseite"},
}


@pytest.mark.parametrize(
    ("name", "side"),
    [(name, side) for sides in SIDES.values() for side, names in sides.items() for name in names.split("|")],
)
def test_a_side_is_told_in_every_language(name: str, side: str) -> None:
    assert guess(name, "°C").at == f"column.{side}"


@pytest.mark.parametrize(
    "name", ["Temp. fuori", "Dehors", "Vnější teplota", "Na zewnątrz", "Buiten", "Temperatura fuera", "Temp. exterior"]
)
def test_what_is_outside_is_told_in_every_language(name: str) -> None:
    assert guess(name, "°C").at == "outside"


@pytest.mark.parametrize(("name", "side"), [("Rodamiento delante", "front"), ("Cuscinetto dietro", "rear")])
def test_the_words_for_sides_are_those_of_bearings_too(name: str, side: str) -> None:
    assert guess(name, "°C").at == f"spindle.bearing.{side}"
