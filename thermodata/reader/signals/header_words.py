"""What columns are called that name what is measured, where it comes from, or its value: bare, in lower case."""

from __future__ import annotations

NAME_WORDS = (
    "entityid",
    *(
        "tagname",
        "varname",
        "nodeid",
        "node",
        "displayname",
        "browsename",
        "tag",
        "itemid",
        "tagpath",
        "series",
        "metric",
        "signalname",
        "field",
        "item",
        "itemname",
    ),
    *("name", "point", "channel", "sensor", "sensorid", "sensorname", "signal", "variable", "parameter", "measurand"),
    *("messstelle", "messpunkt", "mpoint", "kanal", "groesse", "größe", "kanál", "veličina", "senzor"),
)
# columns that say which sensor, entity or frame it is, and never how that is
SENSOR_IDS = (
    "sensorid",
    "sensorname",
    "sensorno",
    "entityid",
    "frameid",
    "childframeid",
    "probeid",
    "tagindex",
    "tagid",
    *("ch", "chno", "chnr", "channelno", "channelnr", "kanalnr", "sensornr", "sensornumber", "probeno", "probenr"),
    *("fühlernr", "fuehlernr", "slave", "slaveid", "unitid", "port", "addr", "address", "adresse", "mac", "macaddress"),
    *("rom", "romid", "epc", "eui", "deveui", "serial", "serialno", "serialnr", "serialnumber"),
)
# and which of several machines wrote a row
HOST_IDS = (
    "host",
    "hostname",
    "device",
    "deviceid",
    "devicename",
    "plc",
    "logger",
    "machineid",
    "machinename",
    "gerät",
)
# columns that name what is measured
SENSOR_WORDS = (
    *SENSOR_IDS,
    *("sensor", "probe"),
    *(
        "measurand",
        "messstelle",
        "messpunkt",
        "fühler",
        "fuehler",
        "senzor",
        "čidlo",
        "capteur",
        "sonda",
        "thermocouple",
    ),
)
# columns that name where a value comes from, or what is told of it
LABEL_WORDS = (
    *("device", "deviceid", "devicename", "host", "hostname", "machine", "machineid", "machinename", "asset", "plc"),
    *("station", "location", "place", "area", "line", "unitname", "room", "equipment", "source", "logger", "module"),
    *("measurement", "stat", "statistic", "aggregate", "aggregation", "axis", "l0name", "l1name", "l2name"),
    *("gerät", "maschine", "anlage", "ort", "standort", "achse", "zařízení", "stroj", "místo", "osa"),
)
VALUE_WORDS = ("value", "wert", "messwert", "reading", "hodnota", "measurement")
# columns that hold the unit of the value beside them
UNIT_WORDS = (
    *("unit", "units", "einheit", "jednotka", "engineeringunits", "unité", "unità", "unidad", "engunits", "engunit"),
    *("engineeringunit", "euunits", "unitofmeasure", "unitsofmeasure", "unitofmeasurement", "unitsofmeasurement"),
    *("measurementunit", "messeinheit", "maßeinheit", "masseinheit", "unitédemesure", "unitàdimisura"),
    *(
        "unidaddemedida",
        "unidade",
        "eenheid",
        "enhet",
        "enhed",
        "jednostka",
        "mértékegység",
        "单位",
        "單位",
        "単位",
        "단위",
    ),
)
# which they are called for short; other things are, too
UNIT_SHORT = ("u", "e", "j", "eh", "einh", "jedn", "uom", "um", "eu", "egu")
