"""cp1250 or cp1252: header lines of thirteen languages read by us and by charset-normalizer.

    uv run --with charset-normalizer python tests/benchmarks/letters.py

Each line stands above 200 rows of numbers, as in a log. "asked" is a refusal that asks for the encoding. The lines were
written after the word lists of `thermodata/reader/text/file/letters.py`, and are not taken into them.
"""

from __future__ import annotations

from collections.abc import Callable

from thermodata.errors import FormatError
from thermodata.reader.text import decode

WESTERN = {
    "French": [
        "Temps;Température palier arrière;Débit d'huile;Vitesse",
        "Horodatage;Broche côté opérateur (°C);Courant moteur",
        "Durée;Temp. bâti arrière;Temp. bâti avant",
        "Température extérieure;Pression hydraulique",
        "Roulement supérieur;Roulement inférieur;Répartiteur",
        "Données brutes;Capteur n°1;Écart",
        "Étalonnage;Déplacement Z",
        "Eau glycolée entrée;Eau glycolée départ;Hygrométrie",
        "Groupe froid: arrivée;Groupe froid: départ",
        "Échauffement du réducteur;Fréquence",
    ],
    "Spanish": [
        "Fecha;Rodamiento husillo delantero;Presión",
        "Posición Z;Velocidad husillo",
        "Tª columna izquierda;Tª columna derecha;Señal",
        "Refrigeración;Caudal líquido",
        "Máquina;Año;Día",
        "Cojinete;Tensión;Histéresis",
    ],
    "Portuguese": [
        "Rolamento dianteiro;Vazão óleo",
        "Horário;Temperatura do fuso (°C);Rotação",
        "Posição;Variação térmica",
    ],
    "Italian": ["Umidità;Velocità mandrino", "Unità;Cuscinetto anteriore", "Capacità termica;Qualità dell'aria"],
    "German": [
        "Zeit;Spindellager vorne;Öltemperatur;Kühlung",
        "Bett rückseitig;Hallenluft oben",
        "Drehzahl;Vorschub;Kühlmittelrücklauf",
        "Maßstab;Ständer;Führung",
    ],
    "Swedish": ["Tid;Spindellager främre;Kylvätska", "Oljetemperatur;Mätdon;Tryck på"],
}
CENTRAL = {
    "Czech": [
        "Čas;Ložisko přední;Ložisko zadní",
        "Vřeteno otáčky;Výkon;Posuv",
        "Teplota oleje;Teplota haly východ;Průtok",
        "Datum a čas;Šroub X;Šroub Y",
        "Těleso stojanu;Mazání;Větrání",
        "Rychlost;Proud osy;Napětí",
        "Číslo měření;Hodnota",
        "Nádrž;Okolí;Světelná závora",
        "Řídicí systém;Příčné saně",
        "Matice kuličkového šroubu",
    ],
    "Polish": [
        "Czas;Łożysko przód;Łożysko tył",
        "Prędkość;Obciążenie",
        "Ciśnienie;Przepływ",
        "Temperatura śruby;Korpus",
        "Położenie;Próbka",
    ],
    "Hungarian": ["Idő;Főorsó csapágy;Hűtővíz", "Hőmérséklet;Környezet", "Előtolás;Nyomás"],
    "Slovak": ["Čas;Ložisko;Vreteno", "Teplota okolia;Dĺžka"],
    "Croatian": ["Vrijeme;Ležaj prednji;Protok", "Vođica;Pločica"],
    "Slovene": ["Čas;Ležaj;Vodilo spredaj;Pretok hladila;Črpalka"],
    "Romanian": ["Timp;Lagăr faţă;Turaţie"],
}


def rows(header: str) -> str:
    cells = header.count(";")
    return "".join(
        f"12:{i // 60:02d}:{i % 60:02d};"
        + ";".join(f"{20 + i / 100:.2f}".replace(".", ",") for _ in range(cells))
        + "\n"
        for i in range(200)
    )


def ours(data: bytes) -> str | None:
    try:
        return decode(data)[0]
    except FormatError:
        return None


def normalizer(data: bytes) -> str | None:
    from charset_normalizer import from_bytes

    best = from_bytes(data, cp_isolation=["cp1250", "cp1252"]).best()
    return None if best is None else str(best)


def table(readers: dict[str, Callable[[bytes], str | None]]) -> None:
    print("reader              right  asked  wrong  wrong, for example")
    for name, read in readers.items():
        counts, example = {"right": 0, "asked": 0, "wrong": 0}, ""
        for lines, encoding in ((WESTERN, "cp1252"), (CENTRAL, "cp1250")):
            for header in (h for some in lines.values() for h in some):
                text = read(f"{header}\n{rows(header)}".encode(encoding))
                first = None if text is None else text.partition("\n")[0]
                mark = "asked" if first is None else "right" if first == header else "wrong"
                counts[mark] += 1
                example = example or (str(first) if mark == "wrong" else "")
        print(f"{name:18} {counts['right']:6} {counts['asked']:6} {counts['wrong']:6}  {example}")


if __name__ == "__main__":
    asked: dict[str, Callable[[bytes], str | None]] = {"thermodata": ours}
    try:
        import charset_normalizer

        asked[f"charset-normalizer {charset_normalizer.__version__}"] = normalizer
    except ImportError:
        print("charset-normalizer is not installed, so it is left out")
    table(asked)
