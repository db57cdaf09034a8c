"""The parameter table: one row a number, its range, unit, meaning and clause.

A parameter is addressed as the manuals print it: `201#4` a bit, `1320.Z` an axis value, `1006#3.X` the bit of
an axis. Numbers of 9000 ff. are ours: constants of the emulated machine.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum


class ParameterKind(Enum):
    """What a parameter holds."""

    BITS = "bits"
    INTEGER = "integer"
    REAL = "real"
    ANGLE_COUNT = "0.001 deg counts; with a point degrees"
    LETTER = "axis letter"


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterEntry:
    """One row of the parameter table."""

    number: int
    kind: ParameterKind
    per_axis: bool
    low: float
    high: float
    unit: str
    meaning: str
    clause: str
    bits: Mapping[int, str] = field(default_factory=dict)
    """bit number -> meaning"""


_RULINGS = "rulings, section 0"
_HOBBING = "hobbing, 相关参数"
_INCLINED = "988TD 倾斜轴, 四、参数"
FAR = 99999.999

_BIT_ROWS: tuple[tuple[int, bool, str, dict[int, str]], ...] = (
    (
        201,
        False,
        _HOBBING,
        {
            7: "sync type: 1 follow, 0 interpolated",
            4: "ECN: 1 = G81, G51.2 may be repeated in sync",
            3: "1 = RESET leaves sync on",
            2: "G99 in sync by 1 = theoretical, 0 = measured speed of the work axis",
        },
    ),
    (
        1006,
        True,
        "Fanuc 1006",
        {0: "1 = rotary axis", 1: "0 = rotary type A, 1 = type B", 3: "1 = programmed in diameter"},
    ),
    (
        1300,
        False,
        "Fanuc 1300; inclined axis, 存储行程极限",
        {
            0: "OUT: stroke limit 2 forbids 0 = the inside, 1 = the outside of its area",
            7: "BFA: alarm of stroke limits 1 and 3 0 = after, 1 = before the limit is crossed",
        },
    ),
    (
        1301,
        False,
        "Fanuc 1301; inclined axis, 移动前行程检测",
        {7: "PLC: 1 = end points are checked against the stroke limits before the motion"},
    ),
    (
        1310,
        True,
        "Fanuc 1310",
        {0: "OT2: 1 = stroke limit 2 checks the axis", 1: "OT3: 1 = stroke limit 3 checks the axis"},
    ),
    (
        3401,
        False,
        "rulings, section 1, Numbers",
        {0: "DPI: a number without point counts 1 = units, 0 = increments"},
    ),
    (
        5002,
        False,
        "Fanuc 5002",
        {
            2: "LWT: the wear of a tool offset by 0 = moving the axes, 1 = the zero point alone",
            4: "LGT: the geometry of a tool offset by 0 = the zero point alone, 1 = moving the axes",
            6: "LWM: that move is made 0 = in the block of the T, 1 = with the next absolute words",
        },
    ),
    (
        8200,
        False,
        _INCLINED,
        {0: "AAC: inclined axis on", 2: "AZR: 1 = orthogonal axis stays in manual return"},
    ),
    (
        8201,
        False,
        _INCLINED,
        {
            0: "AOT: stroke limit 1 Cartesian",
            1: "AO2: stroke limit 2 Cartesian",
            2: "AO3: stroke limit 3 Cartesian",
        },
    ),
    (
        9005,
        True,
        "rulings, section 2",
        {
            0: "1 = analogue spindle: it turns by S and has no position control",
            1: "1 = with an encoder, which a gear box of the follow type and a feed per revolution need",
        },
    ),
    (8209, False, _INCLINED, {0: "ARF: G28 from the intermediate point 1 = Cartesian, 0 = on the slide"}),
)
_ROWS: tuple[tuple[int, str, bool, float, float, str, str, str], ...] = (
    (197, "INTEGER", False, 0, 5, "", "EGB_MASTERAX: system axis number of the tool axis", _HOBBING),
    (198, "INTEGER", False, 0, 5, "", "EGB_SLAVEAX: system axis number of the work axis", _HOBBING),
    (199, "INTEGER", False, 0, 5, "", "EGB_AXIALAX: system axis number of the axial axis", _HOBBING),
    (1020, "LETTER", True, 65, 90, "", "axis letter", "Fanuc 1020"),
    (1022, "INTEGER", True, 0, 3, "", "basic axis: 1 X, 2 Y, 3 Z, 0 none", "Fanuc 1022"),
    (1240, "REAL", True, -FAR, FAR, "mm | deg", "first reference point, machine coordinate", "Fanuc 1240"),
    (1241, "REAL", True, -FAR, FAR, "mm | deg", "second reference point, machine coordinate", "Fanuc 1241"),
    (1242, "REAL", True, -FAR, FAR, "mm | deg", "third reference point, machine coordinate", "Fanuc 1242"),
    (1243, "REAL", True, -FAR, FAR, "mm | deg", "fourth reference point, machine coordinate", "Fanuc 1243"),
    (1320, "REAL", True, -FAR, FAR, "mm", "stored stroke limit 1, plus side", "Fanuc 1320"),
    (1321, "REAL", True, -FAR, FAR, "mm", "stored stroke limit 1, minus side", "Fanuc 1321"),
    (1322, "REAL", True, -FAR, FAR, "mm", "stored stroke limit 2, plus side", "Fanuc 1322"),
    (
        1323,
        "REAL",
        True,
        -FAR,
        FAR,
        "mm",
        "stored stroke limit 2, minus side; equal = no area",
        "Fanuc 1323",
    ),
    (1324, "REAL", True, -FAR, FAR, "mm", "stored stroke limit 3, plus side", "Fanuc 1324"),
    (
        1325,
        "REAL",
        True,
        -FAR,
        FAR,
        "mm",
        "stored stroke limit 3, minus side; equal = no area",
        "Fanuc 1325",
    ),
    (1410, "REAL", False, 1, 1e6, "mm/min", "dry run speed", "Fanuc 1410"),
    (1420, "REAL", True, 1, 1e6, "mm/min | deg/min", "rapid speed of the slide", "Fanuc 1420"),
    (1421, "REAL", True, 1, 1e6, "mm/min | deg/min", "F0: speed at rapid override 0", "Fanuc 1421"),
    (1423, "REAL", True, 1, 1e6, "mm/min | deg/min", "jog speed", "Fanuc 1423"),
    (1430, "REAL", True, 1, 1e6, "mm/min | deg/min", "highest cutting feed of the slide", "Fanuc 1430"),
    (1660, "REAL", True, 1, 1e6, "mm/s2 | deg/s2", "highest acceleration", "Fanuc 1660"),
    (3410, "REAL", False, 0, FAR, "mm", "what the radius of an arc may differ at its end", "Fanuc 3410"),
    (3772, "REAL", True, 0, 60000, "rpm", "highest speed as a spindle; 0 = no spindle", "Fanuc 3772"),
    (8210, "ANGLE_COUNT", False, -180000, 180000, "0.001 deg", "inclination", _INCLINED),
    (8211, "INTEGER", False, 0, 99, "", "system axis number of the inclined axis", _INCLINED),
    (8212, "INTEGER", False, 0, 99, "", "system axis number of the orthogonal axis", _INCLINED),
    (9001, "INTEGER", False, 1, 5, "", "system axis number of the work spindle", _RULINGS),
    (9002, "INTEGER", False, 1, 5, "", "system axis number of the tool spindle", _RULINGS),
    (
        9003,
        "INTEGER",
        False,
        -1,
        1,
        "",
        "k: sense of the work axis against Z for a right-hand gear",
        _RULINGS,
    ),
    (9004, "INTEGER", False, 1, 5, "", "most axes that one block may move together (PS0015)", _RULINGS),
    (
        9006,
        "REAL",
        False,
        0,
        1296000,
        "arcsec",
        "window of the gear box: error of the slave beyond which SV0407 cancels it; 0 = not watched",
        _RULINGS,
    ),
)

_SWITCH_CLAUSE = "Fanuc 6910-6965; inclined axis, 注意 9"
SWITCHES = 16
"""position switches"""
_SWITCH_ROWS = tuple(
    row
    for n in range(1, SWITCHES + 1)
    for row in (
        (6909 + n, "INTEGER", False, 0, 5, "", f"position switch {n}: axis number, 0 = off", _SWITCH_CLAUSE),
        (6929 + n, "REAL", False, -FAR, FAR, "mm | deg", f"position switch {n}: upper end", _SWITCH_CLAUSE),
        (6949 + n, "REAL", False, -FAR, FAR, "mm | deg", f"position switch {n}: lower end", _SWITCH_CLAUSE),
    )
)

SWITCH_NUMBERS = tuple(row[0] for row in _SWITCH_ROWS)

PARAMETERS: dict[int, ParameterEntry] = {
    number: ParameterEntry(
        number=number,
        kind=ParameterKind[kind],
        per_axis=per_axis,
        low=low,
        high=high,
        unit=unit,
        meaning=meaning,
        clause=clause,
    )
    for number, kind, per_axis, low, high, unit, meaning, clause in (*_ROWS, *_SWITCH_ROWS)
} | {
    number: ParameterEntry(
        number=number,
        kind=ParameterKind.BITS,
        per_axis=per_axis,
        low=0,
        high=1,
        unit="",
        meaning="; ".join(f"#{bit} {words}" for bit, words in bits.items()),
        clause=clause,
        bits=bits,
    )
    for number, per_axis, clause, bits in _BIT_ROWS
}
"""Every parameter, by number."""
