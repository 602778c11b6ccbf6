"""Names as words: humps, digits and diacritics apart, whatever the script; and plain letters for channel names."""

from __future__ import annotations

import re
import unicodedata

from thermodata.schema.campaign import RESERVED_NAMES

_LETTERS = str.maketrans(
    {
        "ß": "ss",
        "ẞ": "SS",
        "Ł": "L",
        "ł": "l",
        "Ø": "O",
        "ø": "o",
        "đ": "d",
        "Đ": "D",
        "Æ": "AE",
        "æ": "ae",
        "œ": "oe",
        "Œ": "OE",
        "ı": "i",
        "µ": "u",
        "μ": "u",
        "°": "",
        "℃": "degC",
    }
)
# 'Xload', 'S1rpm': an axis letter before a word, as MTConnect adapters write it; S is the spindle
_MTCONNECT = re.compile(
    r"(?<![A-Za-z])([XYZABCS])(\d?)(abs|actm|actw|act|com|cmd|current|curr|cur|frt|load|motor|"
    r"mot|ovr|pos|rpm|speed|temperature|temp|torque|velocity|vel|axis|travel|position)(?![a-z])"
)
_LETTERS_OF_CYRILLIC = """а:a б:b в:v г:g д:d е:e ё:e ж:zh з:z и:i й:j к:k л:l м:m н:n о:o п:p р:r с:s
т:t у:u ф:f х:h ц:c ч:ch ш:sh щ:sch ъ:_ ы:y ь:_ э:e ю:yu я:ya і:i ї:yi є:ye ґ:g"""
_CYRILLIC = dict(pair.split(":") for pair in _LETTERS_OF_CYRILLIC.split())
# The syllables of the signs that machine logs use; a sign outside is written by its code.
_SYLLABLES = """
主:zhu 轴:zhou 軸:zhou 前:qian 后:hou 後:hou 中:zhong 承:cheng 温:wen 溫:wen 度:du 转:zhuan 轉:zhuan 速:su
进:jin 進:jin 给:gei 給:gei 冷:leng 却:que 卻:que 液:ye 水:shui 油:you 车:che 車:che 间:jian 間:jian 环:huan
環:huan 境:jing 室:shi 气:qi 空:kong 螺:luo 母:mu 丝:si 絲:si 杠:gang 杆:gan 电:dian 電:dian 机:ji 機:ji
流:liu 压:ya 壓:ya 功:gong 率:lv 负:fu 載:zai 载:zai 荷:he 扭:niu 矩:ju 位:wei 置:zhi 移:yi 立:li 柱:zhu
床:chuang 身:shen 工:gong 作:zuo 台:tai 刀:dao 具:ju 箱:xiang 柜:gui 门:men 門:men 开:kai 開:kai 关:guan
關:guan 状:zhuang 态:tai 量:liang 湿:shi 濕:shi 地:di 面:mian 基:ji 上:shang 下:xia 左:zuo 右:you 热:re 熱:re
误:wu 差:cha 变:bian 形:xing 光:guang 栅:shan 导:dao 轨:gui 滑:hua 座:zuo 横:heng 梁:liang 枕:zhen 号:hao
测:ce 点:dian 通:tong 道:dao 值:zhi 时:shi 日:ri 期:qi 入:ru 出:chu 口:kou 回:hui 供:gong 夹:jia 件:jian
伸:shen 长:chang 标:biao 定:ding 实:shi 际:ji 部:bu 端:duan 内:nei 外:wai 一:yi 二:er 三:san 四:si 润:run
泵:beng 补:bu 偿:chang 角:jiao 试:shi 验:yan 数:shu 据:ju 传:chuan 感:gan 器:qi 坐:zuo 向:xiang 振:zhen
动:dong 力:li 阀:fa 风:feng 扇:shan
"""
_PINYIN = dict(pair.split(":") for pair in _SYLLABLES.split())

# signs of China, kana, and the syllables of Hangul
_EASTERN = "\u2e80-\u9fff\uac00-\ud7a3"


def without_marks(text: str) -> str:
    """Without diacritics, but with signs of scripts that have no letters as they are."""
    bare = "".join(c for c in unicodedata.normalize("NFKD", text.translate(_LETTERS)) if not unicodedata.combining(c))
    return unicodedata.normalize("NFC", bare)  # or a syllable of Hangul would stay in pieces


def words(name: str) -> str:
    """'Eddy/nActSpeed_Z1' -> 'eddy n act speed z 1', '主轴T1' -> '主轴 t 1': no case, no diacritics, humps and digits
    apart."""
    bare = _MTCONNECT.sub(lambda m: f"{'spindle' if m[1] == 'S' else m[1]}{m[2]} {m[3]}", without_marks(name))
    bare = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", bare)
    bare = re.sub(r"(?<=[^\W\d_])(?=\d)|(?<=\d)(?=[^\W\d_])", " ", bare)
    bare = re.sub(rf"(?<=[A-Za-z])(?=[{_EASTERN}])|(?<=[{_EASTERN}])(?=[A-Za-z])", " ", bare)
    return " ".join(re.split(r"[\W_]+", bare)).strip().lower()


def plain(name: str) -> str:
    """Any text in the letters, digits and '_' of a channel name (not yet a legal one): transliterated, never dropped
    where it has a letter or a number in it."""
    out: list[str] = []
    for sign in without_marks(name):
        if sign.isascii():
            out.append(sign if sign.isalnum() else "_")
        elif sign.lower() in _CYRILLIC:
            letter = _CYRILLIC[sign.lower()].replace("_", "")
            out.append(letter.capitalize() if sign.isupper() else letter)
        elif sign in _PINYIN:
            out.append(f"_{_PINYIN[sign]}_")
        elif sign.isalpha():
            # 'GREEK SMALL LETTER THETA', 'KATAKANA LETTER KA', 'HANGUL SYLLABLE GAG': the last word is the sound
            said = unicodedata.name(sign, "").split()
            last = said[-1] if said else ""
            out.append(f"_{last.lower()}_" if last.isalpha() and last.isascii() else f"_u{ord(sign):x}_")
        else:
            digit = unicodedata.digit(sign, None)
            out.append("_" if digit is None else str(digit))
    return re.sub(r"_+", "_", "".join(out)).strip("_")


def channel_name(wanted: str, taken: set[str]) -> str:
    """A legal name, unique ignoring case and added to `taken`: `wanted`, or `wanted_2` where it is taken."""
    base = plain(wanted) or "channel"
    base = (base if base[0].isalpha() else f"ch_{base}")[:60].rstrip("_")
    name, n = base, 1
    while name.lower() in taken or name.lower() in RESERVED_NAMES:
        n += 1
        name = f"{base}_{n}"
    taken.add(name.lower())
    return name
