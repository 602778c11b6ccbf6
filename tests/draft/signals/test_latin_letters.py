"""Chinese and Japanese in Latin letters, and words of the trade that say their place or are asked."""

from __future__ import annotations

import pytest

from thermodata.draft.signals.guess import guess


@pytest.mark.parametrize(
    ("name", "unit", "quantity", "at"),
    [
        ("zhuzhou_qian_zhoucheng", "degC", "temperature", "spindle.bearing.front"),
        ("ZhuzhouHouZhoucheng_wendu", "degC", "temperature", "spindle.bearing.rear"),
        ("hengliang_xia", "degC", "temperature", "crossbeam.bottom"),
        ("chejian shang", "degC", "temperature", "hall.top"),
        ("Y_simu_luomu", "degC", "temperature", "axis.y.nut"),
        ("X zhou sigang", "degC", "temperature", "axis.x.screw"),
        ("lengqueye", "degC", "temperature", "coolant"),
        ("yeya_youxiang", "degC", "temperature", "hydraulics"),
        ("weiyi_Z", "mm", "displacement", "tcp"),
        ("zhuzhou_zhuansu", "rpm", "rotational_speed", "spindle"),
        ("Y_jinji_sudu", "m/min", "feed", "axis.y"),
        ("shujiku_mae_jikuuke_ondo", "degC", "temperature", "spindle.bearing.front"),
        ("ondo_column_ushiro", "degC", "temperature", "column.rear"),
        ("sagyo_yu_tank", "degC", "temperature", "hydraulics"),
        ("reikyakusui_kyokyu", "degC", "temperature", "chiller.supply"),
        ("kuki_ondo", "degC", "temperature", "hall"),
        ("C_jiku_motor", "degC", "temperature", "rotary.c.motor"),
        ("hen-i_Z", "um", "displacement", "tcp"),
        ("shujiku_kaitensu", "rpm", "rotational_speed", "spindle"),
        ("Z_okuri_sokudo", "m/min", "feed", "axis.z"),
        ("T_sala", "degC", "temperature", "hall"),
        ("T_soporte_sensor", "degC", "temperature", "fixture"),
        ("T_agua_refrigeracion", "degC", "temperature", "chiller"),
        ("T_support_sonde", "degC", "temperature", "fixture"),
        ("T_huile_lub", "degC", "temperature", "lubrication"),
        ("T_enceinte_machine", "degC", "temperature", "enclosure"),
        ("T_enceinte_climatique", "degC", "temperature", "hall"),
        ("Schleifkopf", "degC", "temperature", "headstock"),
    ],
)
def test_a_word_of_a_lab_is_its_place(name: str, unit: str, quantity: str, at: str) -> None:
    said = guess(name, unit)
    assert (said.quantity, said.at, said.questions) == (quantity, at, ())


@pytest.mark.parametrize("name", ["men", "T_men", "T_xia", "hou_1", "T_simu", "T_mae", "ue", "mado_3", "T_you"])
def test_a_short_word_alone_says_nothing(name: str) -> None:
    said = guess(name, "degC")
    assert said.at is None
    assert any("where on the machine?" in q for q in said.questions)


def test_a_side_counts_beside_a_word_of_its_own_language_only() -> None:
    assert guess("T_column_hou", "degC").at == "column"
    assert guess("lizhu_hou", "degC").at == "column.rear"
    assert guess("chejian_men", None).at == "hall.door"


@pytest.mark.parametrize(
    ("name", "at", "asked"),
    [
        ("T_air_enceinte", "enclosure", "hall, of a chamber around the machine?"),
        ("T_aire_cojinete", "pneumatics", "or spindle.bearing itself?"),
        ("T_granito", "bed", "of granite?"),
        ("T_estator", None, "which motor?"),
        ("Werkstueckspindel_Lager", None, "counter_spindle.bearing, as a second spindle, or rotary.c.bearing"),
    ],
)
def test_a_word_with_two_senses_is_asked(name: str, at: str | None, asked: str) -> None:
    said = guess(name, "degC")
    assert (said.at, said.sure) == (at, False)
    assert asked in said.questions[0]
