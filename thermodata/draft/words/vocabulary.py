"""What labs write, by what it means: English, German, Czech and Chinese, with the abbreviations of the trade; further
languages stand in languages/.

Case, diacritics and humps are gone before matching (naming.py). A word is looked for anywhere in the name
('lager' finds 'Spindellager'); 'nut.' is a whole word only, '^hall' the beginning of one. Signs of Chinese are
looked for anywhere. Words that would catch others by chance are therefore written with the dot.
"""

from __future__ import annotations

from functools import lru_cache

from thermodata.draft.words.languages import in_all_languages
from thermodata.draft.words.listed import holds_word

_QUANTITY_WORDS: dict[str, str] = {
    "temperature": "temper temp teplot ^tepl tmp. t. theta. pt~100 pt~1000 rtd. rtds. thermocouple thermoel thermistor "
    "^thermo. ntc. tc. celsius degc. waerme. temperatura 温度 溫度 温 溫",
    "rotational_speed": "drehzahl drehz. otack otacek otac. rpm. rpm rotat~speed rotation~speed spindle~speed "
    "spindlespeed spindle~velocity spindel~speed umdrehung revolution n~act n~ist n~actual n~spindle n~soll "
    "s~act~speed acts. sspeed. srpm. spd. act~speed actspeed speed.~act speed. ^speed rpms. "
    "tacho. tachometer tachogenerator tachometr 转速 轉速 回转速度 主轴速度 vact~spindle "
    "n. rotvel ot~vret ot~vretene ot~vreteno ot~vretena ot~prac~vret ot~prac~vretene",
    "feed": "vorschub feedrate feed. ^feed~rate feed~act actfeed posuv 进给 進給 frt. actf. fact. pathfeed "
    "v~act v~actual vact. vaxis. bahngeschw feed~speed",
    "power": "power. ^power leistung wirkl vykon prikon 功率 pwr. watt. p~act p~mech p~elec p~el. puissance "
    "activepower",
    "load": "load. ^load. auslast motorlast spindellast zatizen zatez vytizen 负载 負載 负荷 負荷 utiliz utilis util. "
    "spindleload servoload loadmeter last.",
    "torque": "torque drehmoment moment. momente. krout trq. 扭矩 转矩 轉矩 力矩 mdreh m~act",
    "current": "current. currents. ^current motorstrom strom. stroms. strom ^proud 电流 電流 curr. curr ampere amps. "
    "amp. i~act i~ist i~actual i~nom iact. imot. irms. iq. courant",
    "position": "position ^pos. pos. ^poloh 位置 坐标 坐標 coordinate koordinat encoder. enc. istpos actm. actw. "
    "xpos. ypos. zpos. xabs. yabs. zabs. xact. yact. zact. s~act s~actual abspos mcs. wcs. machinecoord",
    "flow": "flow. ^flow~ flowrate durchfluss durchfl. prutok 流量 volumenstrom volume~flow throughput. flowmeter",
    "pressure": "pressure press. ^druck. druck. hydraulikdruck oldruck luftdruck druck~ tlak 压力 壓力 压强 气压 "
    "油压 液压力",
    "humidity": "humid feucht ^vlhkost vlhk. 湿度 濕度 rh. relhum hum.",
    "irradiance": "irradia solar. sonnen sonne. slunecn slunce. zaren 日照 辐射 辐照 pyranom sunlight sun. "
    "globalstrahl",
    "displacement": "messuhr feinzeiger millesimaltaster induktivtaster messtaster dial~gauge dial~indicator dial~test "
    "comparator comparador comparateur uchylkomer 千分表 百分表 杠杆表 ダイヤルゲージ 다이얼게이지 "
    "eddy displac verlager verschieb posunut posuv~vretene vychylk deformac deform. deformation "
    "wirbelstrom wegsens wegaufnehmer wegmess messtaster lvdt. lvdts. gap. gapsensor abstand. vzdalenost "
    "位移 热误差 熱誤差 热变形 变形 热伸长 伸长 热漂移 thermal~error thermal~drift thermal~growth dilatac "
    "ausdehn capacitive~s kapazitiv elongat prodlouz nci. d~x d~y d~z dx. dy. dz. ex. ey. ez. "
    "delta~x delta~y delta~z err~x err~y err~z error~x error~y error~z deltax. deltay. deltaz. "
    "disp. tcp~x tcp~y tcp~z snimac~x snimac~y snimac~z growth. drop. weg. wege. drift.",
    "tilt": "tilt neigung naklon inclin pitch. roll. yaw. 倾斜 倾角 drot. rx. ry. rz. d~rx d~ry d~rz",
    "angle": "angle. winkel uhel. uhlu. 角度 转角",
    "voltage": "voltage spannung napeti 电压 電壓 volt. volts. uzk. u~zk u~dc udc. dc~link zwischenkreis dcvolt",
    "resistance": "resistanc widerstand odpor. 电阻 電阻",
    "state": "on. off. ein. zap. vyp. zapnut. vypnut. open. opened. closed. offen. geschlossen. active. aktiv. "
    "aktivni. status. state. ^state. stav. stavu. zustand. enabled. enable. running. run. flag. alarm. alarms. "
    "fault. mode. modus. rezim. 状态 狀態 开关 运行 报警 启动 停止 is~on isopen. ok. ready. freigabe. execution. "
    "otevren. zavren.",
}

_PLACE_WORDS: dict[str, str] = {
    "spindle": "mot~s. current~s. curr~s. load~s. s~load. s~temp. s~mot. s~current. spindel "
    "spindle vreten 主轴 主軸 电主轴 spdl. spnd. spin. sp. spi. spindl",
    "main spindle": "main~spindle hauptspindel hsp. broche~principale mandrino~principale hlavni~vret "
    "husillo~principal 主主轴 第一主轴 メインスピンドル 主スピンドル 메인스핀들 wrzeciono~glowne главн~шпиндел",
    "counter spindle": "counter~spindle counterspindle sub~spindle subspindle gegenspindel gsp. abgreifspindel "
    "contre~broche contrebroche reprise~broche broche~de~reprise contromandrino contro~mandrino "
    "contrahusillo contra~husillo subhusillo protivret proti~vret przeciwwrzecion противошпиндел 副主轴 "
    "背主轴 第二主轴 サブスピンドル 背面主軸 対向主軸 第二主軸 サブ主軸 서브스핀들 서브~스핀들 서브주축",
    "milling spindle": "milling~spindle mill~spindle frasspindel fraesspindel broche~de~fraisage broche~fraisage "
    "mandrino~fresa mandrino~di~fresatura mandrino~fresatura husillo~de~fresado husillo~fresado frezovaci~vret "
    "wrzeciono~frez фрезерн~шпиндел 铣主轴 动力主轴 ミーリング主軸 フライス主軸 밀링~스핀들 밀링스핀들",
    "turret": "turret revolver. revolverkopf werkzeugrevolver driven~tool driven~tools live~tool live~tools livetool "
    "tourelle torretta torreta revolverov. revolverova nozova~hlava glowica~rewolwer револьвер 刀塔 动力刀 "
    "タレット 回転工具 터렛 angetriebene~werkzeuge motorizzat outil~tournant outils~tournants",
    # of a grinder, whose spindle turns it
    "grinding wheel": "grinding~wheel wheel~spindle wheel~speed wheel~power schleifscheibe schleifspindel "
    "brusny~kotouc brusneho~vretene brusne~vreteno 砂轮 砂輪 砥石 toishi",
    # what tilts a table, on bearings of its own
    "trunnion": "trunnion cradle. berceau wiege. schwenkbrucke schwenkbruecke kolebk 摇篮",
    "workhead": "workhead werkstuckspindel werkstueckspindel wss. prac~vret prac~vretene prac~vreteno prac~vretenik "
    "pracovni~vreteno pracovni~vretene pracovniho~vretene pracovniho~vretena pracovnim~vretenu pracovnim~vreteni "
    "pracovni~vretenik pracovniho~vreteniku pracovnim~vreteniku workspindle work~spindle",
    "not spindle": "gewindespindel kugelspindel spindelmutter kugelgewinde leadspindle",
    # a 'Verlagerung' is a displacement, and no bearing
    "bearing": "bearing bearings. (?<!ve[r])lager ^lozis ^loz. 轴承 軸承 brg. brng. bear. roulement cuscinett palier. "
    "spdl~fb spdl~rb spindle~fb spindle~rb sp~fb sp~rb paliers. screw~support ballscrew~support support~of~screw",
    "front": "spdl~fb spindle~fb sp~fb "
    "front vorn vorder ^predni pred. predn. vpredu. zepredu. predek. vorderseite 前 fr. frt~b nose. "
    "spindlenose nase. vl. avant. ant. anteriore.",
    "rear": "spdl~rb spindle~rb sp~rb "
    "rear back. hinten hinter ^zadni zad. zadn. vzadu. zezadu. zadek. ruckseite rueckseite 后 後 tail. rr. "
    "arriere. post. posteriore.",
    # not of 'high speed', nor of how high something is: 'Halle, 1,5 m hoch'
    "upper": r"(?<!\S)(?<![0-9]\sm\s)(?:high|hoch|hohe|vysoko|wysoko|hoog)(?!\S)(?!\s(?:speed|press|prec)) "
    "upper top. ^ober oben. obere ^horni nahore nahoru shora. 上 up. haut. haute. alto. alta. superieur "
    "^superiore",
    "lower": "lower bottom bot. tief. niedrig nizko. nisko. laag. ^unter unten. ^spodni ^dolni dole. zdola. 下 low. "
    "dn. bas. basse. basso. bassa. inferieur ^inferiore",
    "left": "left links. link. linke levy. leva. leve. levo. vlevo. nalevo. 左 l. sx. sinistr gauche.",
    "right": "right rechts. recht. rechte pravy. prava. prave. pravo. vpravo. napravo. 右 r. dx. destra. destro. "
    "droit. droite.",
    "middle": "middle. mitte. mittl stredni. stred. center. centre. 中间 中部",
    "motor": "motor mot. mtr. wdg. wndg. servo. servomotor 电机 電機 马达 伺服 wicklung winding vinuti 绕组 statorwick "
    "motors. stator. statore.",
    # whose winding warms, and which stands still where the tool turns
    "stator": "stator. statore. estator. statoru. 定子 ステータ",
    "nut": "nut. mutter ^matic matka. 螺母 丝母 螺帽 ballnut nuts.",
    "screw": "screw gewindetrieb kgt. kugelgewinde sroub srouby 丝杠 丝杆 絲杠 滚珠 bsc. leadscrew gewindespindel vis. "
    "vite. viti.",
    "scale": "scale. scales. massstab masstab glasmass pravitk 光栅 光柵 linear~encoder glass~scale wegmesssystem",
    "guide": "guideway gway. fuehr. fuhr. guide. guides. ^fuhrung fuehrung linearfuhr vedeni. 导轨 導軌 rail. rails. "
    "slideway 滑块",
    "gearbox": "gearbox getriebe prevodovk 齿轮箱 变速箱 gear.",
    # between motor and spindle, as a gearbox is
    "belt": "belt. belts. beltdrive riemen ^remen. ^remene. ^remenu. 皮带 皮帶 同步带",
    "drive": "drive. drives. umrichter inverter amplifier verstarker menic 驱动器 变频器 converter",
    "column": "column stander staender saule. saeule. maschinensaule stojan sloup 立柱 col. montante. "
    "montanti. montant. colonna. colonne.",
    "bed": "bed. bett. maschinenbett ^loze. lozi. 床身 底座 machinebase base. bedplate podstav machine~base",
    "table": "table. tables. tbl. tisch ^stul. ^stol. stolu. stole. 工作台 转台 轉台 drehtisch rotarytable worktable "
    "tab. tavola. plateau. planscheibe licni~desk~",
    "headstock": "headstock spindelstock spindelkasten spindelgehaus spindelgehaeus spindelkopf schleifkopf "
    "schleifspindelkopf wheelhead wheel~head vretenik 主轴箱 床头箱 spindle~head "
    "spindlehead spindle~housing spindle~box head~stock 主轴头",
    "tailstock": "tailstock reitstock konik. koniku. tail~stock 尾座",
    # 'Stoßelement' is none
    "ram": "ram. stossel(?![e]) stoessel(?![e]) z~schieber frasschieber fraesschieber "
    "pinole traghuls traghuels ^smykadl 滑枕 quill.",
    "saddle": "saddle werkzeugsupport kreuzsupport bettsupport plansupport obersupport schlitten "
    "^sane. 滑座 滑板 滑台 carriage crossslide cross~slide slide. sani.",
    "crossbeam": "crossbeam querbalken querbal traverse. ^pricni 横梁 gantry. cross~rail crossrail beam. portal.",
    "tool": "tool. werkzeug nastroj 刀具 刀柄 toolholder",
    "workpiece": "workpiece werkstuck werkstueck obrobek obrobku 工件 part~temp wkp.",
    "fixture": "fixture vorrichtung pripravek pripravku 夹具 halterung drzak. sensorhalter tasterhalter "
    "messhalter sondenhalter halter~messtaster halter~sonde "
    "probe~bracket probes~bracket probe~holder probes~holder probe~mount probe~nest probe~support probe~stand "
    "sensor~bracket sensor~holder sensor~mount bracket~of~probe bracket~of~probes bracket~probe bracket~probes",
    "probe": "probe. probes. taster. messtaster sonda. sondy. 测头 touchprobe",
    "coolant": "coolant kuhlm kuehlm kss. kuhlschm kuehlschm chladici ^chlaz chladiv emulz emulsion 冷却液 冷卻液 "
    "切削液 冷却 "
    "grinding~fluid mql. mms. cooling kuhlung kuehlung cool. kuhlflu kuhlkreis cutting~fluid cutfluid kuhlen. "
    "cutting~oil schneidol schneidoel bearbeitungsol bearbeitungsoel rezny~olej rezneho~oleje 切削油",
    # of the cut, or of a bearing that runs on oil and air
    "mist": "mist. oil~mist mist~coolant nebel. olnebel oelnebel niebla brouillard nebbia nevoa mlha mgla~olej "
    "mgielka 油雾 喷雾 ミスト",
    "chiller": "chiller chladic. chladice. kuhler. kuehler. spindelkuhler spindelkuehler 冷却机 "
    "ruckkuhl rueckkuhl kuhlaggregat 冷水机 水冷机 油冷机 oilcooler oil~cooler oelkuhler water. wasser "
    "^vod[ay]. kuhlwasser 冷却水 chlazeni~vretene",
    # the way out of the device that cools is the way into the machine
    "out of the chiller": "chiller~out chiller~outlet chiller~output chiller~ausgang chiller~austritt chiller~vystup "
    "冷却机出 冷水机出 水冷机出 油冷机出 チラー出口 冷却装置出口 칠러~출구 칠러출구 sortie~groupe uscita~chiller "
    "chiller~uscita chiller~saida "
    "salida~enfriadora salida~enfriador chiller~wylot chiller~cikis чиллера~выход выход~чиллера",
    "into the chiller": "chiller~in chiller~inlet chiller~input chiller~eingang chiller~eintritt chiller~vstup "
    "冷水机进 水冷机进 油冷机进 チラー入口 冷却装置入口 칠러~입구 칠러입구 entree~groupe ingresso~chiller "
    "chiller~ingresso chiller~entrada "
    "entrada~enfriadora entrada~enfriador chiller~wlot chiller~giris чиллера~вход вход~чиллера",
    # a cooler is the device to one lab, and what is cooled to the next
    "in or out of a cooler": "kuhler~ausgang kuhler~austritt kuehler~austritt kuhlgerat~austritt ruckkuhler~austritt "
    "kuhler~eingang kuhler~eintritt kuehler~eintritt kuhlgerat~eintritt ruckkuhler~eintritt chladic~vystup "
    "vystup~chladic vystup~z~chladic chladice~vystup chladic~vstup vstup~chladic vstup~do~chladic chladice~vstup",
    "supply": "supply. inlet. in. vorlauf zulauf ^privod vstup. 入口 进口 进水 供液 进油 vl. input.",
    "return": "return. outlet. out. rucklauf ruecklauf ablauf zpatec ^odvod vystup. 出口 回水 回油 回液 rl. output.",
    "tank": "液箱 tank. tanks. nadrz behalter behaelter 水箱 油箱 reservoir",
    "hydraulics": "hydraul 液压 液壓 hyd. hydr.",
    "oil": "oil. oel. ol. olej ^oil 油温 油 oltemp oeltemp",
    "lubrication": "lubric schmier mazan mazac 润滑 潤滑 lube. lub.",
    "cabinet": "cabinet schaltschrank schrank rozvade 电柜 电气柜 控制柜 電櫃 elektroschrank switch~box e~cabinet",
    "hall": "hall. ^halle. ^hallen hala. haly. hale. ^ambi amb. umgeb okoli. okoln. okolni raum. raumt raumluft room. "
    "workshop shop. shopfloor luft. lufttemp air. vzduch 室温 环境 環境 车间 車間 气温 室内 空气 environ env. "
    "prostred indoor",
    "pneumatics": "druckluft compressed~air pneumat stlacen 压缩空气 气源 airpressure",
    "outside": "outdoor outside aussen. aussent ^venk[uo] ^vnejs 室外",
    "air": "luft. lufttemp raumluft hallenluft air. vzduch 空气 室温 气温",
    "floor": "floor. boden. bodent hallenboden fussboden fundament foundation podlah ^zaklad 地面 地基 地板",
    "door": "door doors. tur. tuer. schutztur tor. hallentor hallentur hallentuer dvere dveri vrata vrat. gate. 门 門",
    "gate": "tor. hallentor hallentur hallentuer vrata vrat. gate. roller~door",
    "enclosure": "machine~door schutztur schutztuer safety~door guard~door 防护门 安全门 workspace. arbeitsraum "
    "pracovni~prostor",
    # the air in which the part is cut: of the machine, and not of the hall
    "workspace": "enclosure. machine~interior workspace. work~space working~space working~area machining~area "
    "arbeitsraum pracovni~prostor ws~air air~ws "
    "zona~lavoro zona~di~lavoro vano~lavoro enceinte~machine enceinte~de~travail zone~travail zone~de~travail "
    "espace~de~travail",
    # a chamber: the working space, or one that is tempered and holds the whole machine
    "chamber": "chamber. enceinte.",
    "climate chamber": "climate~chamber climatic~chamber klimakammer klimaraum klimatizovana~komora "
    "enceinte~climatique chambre~climatique camera~climatica camara~climatica",
    "frame": "frame. frames. machineframe rahmen. maschinenrahmen maschinengestell gestell. ram~stroje ramu~stroje "
    "bati. telaio. bastidor. rama. 机架",
    "granite": "granite. granit. granito. zula. 花岗岩 大理石 グラナイト",
    "window": "window fenster okno. okna. 窗",
    "sun": "sun. sonne. slunce. solar. sunlight",
    "cnc": "cnc. cnc~temp steuerung. ridici. 数控 control~unit ncu. ipc.",
    "compensation": "kompens compens 补偿 補償 komp. comp.",
    "pump": "pump pumpe. cerpadl 泵",
    "fan": "fan. fans. lufter ventilator 风扇 风机 vetra",
}

QUANTITY_WORDS = {key: in_all_languages(key, own) for key, own in _QUANTITY_WORDS.items()}
PLACE_WORDS = {key: in_all_languages(key, own) for key, own in _PLACE_WORDS.items()}

# Names of what no quantity of a channel holds; the words to the right are told in the draft.
_FOREIGN: tuple[tuple[str, str], ...] = (
    (
        "a time stamp",
        "timestamp ^stamp. stamp. nsec. nanosec. publish~time log~time uptime zeitstempel zeit. ^cas. "
        "时间 "
        "时刻 datum. elapsed. time. date. cas~s sec. secs. laufzeit epoch.",
    ),
    ("how an array is laid out", "layout~dim layout~data~offset"),
    ("a vibration or an acceleration", "vibrat vibrac accel beschleun schwing zrychl 振动 加速度 ^acc. rms~v"),
    ("how far readings scatter", "variance varianz covariance kovarianz stddev std~dev rozptyl"),
    ("a force", "force. forces. kraft. sila. sily. 切削力 作用力 loadcell load~cell. cutting~force vorschubkraft"),
    ("an energy", "energy energie 能耗 电能 kwh."),
    ("a frequency", "frequenc frequenz frekvenc 频率 freq."),
    ("a fill level", "level. fluidlevel oillevel fullstand fuellstand hladin 液位 油位 niveau."),
    ("a strain", "strain. dehnung. dms. 应变 strain~gauge tenzomet"),
    (
        "what a control computes, not the machine",
        "foll~err follow~err follerr following schlepp 跟随误差 distance~to~go dtg. restweg lag~err",
    ),
    ("an override", "override ovr. ovrd. fovr. sovr. korekce~posuvu 倍率"),
    (
        "a number, a count or an identifier",
        "counter count. counts. zaehler zahler. pocitadlo pocet. cislo. nummer. number. nr. index. idx. id. ids. seq. "
        "sequence block. line. satz. satznr program. programm. version checksum crc. sample~nr sample. samples. zeile. "
        "record. "
        "partcount 编号 序号 工件计数 计数 frame~id toolnr. lfdnr. tno. toolid. tool~number current~tool asset",
    ),
    ("a sound level", "sound noise~level larm. hluk"),
    ("a density, a mass or a concentration", "density weight. mass. concentrat dichte. gewicht. ph."),
    ("a duty or quality figure", "duty. quality. snr. rssi."),
)
FOREIGN = tuple((what, in_all_languages(what, own)) for what, own in _FOREIGN)

SETPOINT = in_all_languages(
    "setpoint",
    "soll. ^soll. sollwert set. setpoint. setp. cmd. command. commanded. nominal. nom. target. zadan ziel. pozadov "
    "设定 目标 指令 给定 demand. desired. reference. ref. programmed. prog.",
)
LIMIT = in_all_languages(
    "limit",
    "limit. limits. max. min. maximum. minimum. threshold. grenze. grenzwert warn. warning. 上限 下限 mezni.",
)
# a state of a control or a program, and of no part of the machine
OF_CONTROL = (
    "alarm alarms fault. mode. modus. rezim. ready. freigabe. execution. ok. program programm status. state. enable. "
    "enabled. error. warning. stav. zustand. estado. etat. stato. 报警 状态 運転"
)
DIFFERENCE = in_all_languages(
    "difference",
    "diff. difference differenz rozdil. rozdilu. delta~t deltat. dt. gradient. spread. 温差 温升 "
    "ubertemp temperature~rise rise.",
)


@lru_cache(maxsize=20_000)
def places_in(text: str) -> frozenset[str]:
    """The keys of PLACE_WORDS that a name mentions."""
    return frozenset(key for key, listed in PLACE_WORDS.items() if holds_word(listed, text))


@lru_cache(maxsize=20_000)
def quantities_in(text: str) -> tuple[str, ...]:
    """The keys of QUANTITY_WORDS that a name mentions, in their order."""
    return tuple(key for key, listed in QUANTITY_WORDS.items() if holds_word(listed, text))


@lru_cache(maxsize=20_000)
def foreign_in(text: str) -> str | None:
    """What a name says that it is, where that is none of our quantities."""
    own = text.replace("counter spindle", "spindle")  # which counts nothing
    return next((what for what, listed in FOREIGN if holds_word(listed, own)), None)
