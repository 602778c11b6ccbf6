"""What labs write in Dutch, by the keys of the vocabulary."""

WORDS = {
    "displacement": "verplaatsing",
    "front": "voor. vooraan voorzijde voorkant voorste",
    "rear": "achter. achteraan achterzijde achterkant achterste",
    "upper": "boven. bovenaan bovenzijde bovenkant bovenste",
    "lower": "onder. onderaan onderzijde onderkant onderste",
    "left": "linker. linkerzijde linkerkant",
    "right": "rechter. rechterzijde rechterkant",
    "middle": "midden.",
    "column": "kolom",
    "outside": "buiten. buitentemp buitenlucht",
    "fixture": "sensorhouder tasterhouder",
}
