"""The parameter table, the delivered values of the two set-ups, and overrides by the user.

A parameter is addressed as the manuals print it: `201#4` a bit, `1320.Z` an axis value, `1006#3.X` the bit of
an axis. Numbers of 9000 ff. are ours: constants of the emulated machine.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

from controller.tables.alarms import ControllerError


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


Value = int | float | str
_RULINGS = "rulings, section 0"
_HOBBING = "hobbing, 相关参数"
_INCLINED = "988TD 倾斜轴, 四、参数"
_FAR = 99999.999

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
    (8209, False, _INCLINED, {0: "ARF: G28 from the intermediate point 1 = Cartesian, 0 = on the slide"}),
)
_ROWS: tuple[tuple[int, str, bool, float, float, str, str, str], ...] = (
    (197, "INTEGER", False, 0, 5, "", "EGB_MASTERAX: system axis number of the tool axis", _HOBBING),
    (198, "INTEGER", False, 0, 5, "", "EGB_SLAVEAX: system axis number of the work axis", _HOBBING),
    (199, "INTEGER", False, 0, 5, "", "EGB_AXIALAX: system axis number of the axial axis", _HOBBING),
    (1020, "LETTER", True, 65, 90, "", "axis letter", "Fanuc 1020"),
    (1022, "INTEGER", True, 0, 3, "", "basic axis: 1 X, 2 Y, 3 Z, 0 none", "Fanuc 1022"),
    (1240, "REAL", True, -_FAR, _FAR, "mm | deg", "first reference point, machine coordinate", "Fanuc 1240"),
    (1241, "REAL", True, -_FAR, _FAR, "mm | deg", "second reference point, machine coordinate", "Fanuc 1241"),
    (1242, "REAL", True, -_FAR, _FAR, "mm | deg", "third reference point, machine coordinate", "Fanuc 1242"),
    (1243, "REAL", True, -_FAR, _FAR, "mm | deg", "fourth reference point, machine coordinate", "Fanuc 1243"),
    (1320, "REAL", True, -_FAR, _FAR, "mm", "stored stroke limit 1, plus side", "Fanuc 1320"),
    (1321, "REAL", True, -_FAR, _FAR, "mm", "stored stroke limit 1, minus side", "Fanuc 1321"),
    (1322, "REAL", True, -_FAR, _FAR, "mm", "stored stroke limit 2, plus side", "Fanuc 1322"),
    (
        1323,
        "REAL",
        True,
        -_FAR,
        _FAR,
        "mm",
        "stored stroke limit 2, minus side; equal = no area",
        "Fanuc 1323",
    ),
    (1324, "REAL", True, -_FAR, _FAR, "mm", "stored stroke limit 3, plus side", "Fanuc 1324"),
    (
        1325,
        "REAL",
        True,
        -_FAR,
        _FAR,
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
    (3410, "REAL", False, 0, _FAR, "mm", "what the radius of an arc may differ at its end", "Fanuc 3410"),
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
)

_SWITCH_CLAUSE = "Fanuc 6910-6965; inclined axis, 注意 9"
SWITCHES = 16
"""position switches"""
_SWITCH_ROWS = tuple(
    row
    for n in range(1, SWITCHES + 1)
    for row in (
        (6909 + n, "INTEGER", False, 0, 5, "", f"position switch {n}: axis number, 0 = off", _SWITCH_CLAUSE),
        (6929 + n, "REAL", False, -_FAR, _FAR, "mm | deg", f"position switch {n}: upper end", _SWITCH_CLAUSE),
        (6949 + n, "REAL", False, -_FAR, _FAR, "mm | deg", f"position switch {n}: lower end", _SWITCH_CLAUSE),
    )
)

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

SETUPS = ("hobbing", "tilted")
_AXIS = {str(number): 0.0 for number in (1240, 1241, 1242, 1243, 1322, 1323, 1324, 1325)} | {
    "1421": 500.0,
    "1423": 2000.0,
}
_ROTARY = _AXIS | {"1006": 0b1, "1022": 0, "1310": 0, "1420": 36000.0, "1430": 36000.0, "1660": 3600.0}
_SLIDE = _AXIS | {
    "1006": 0,
    "1022": 0,
    "1310": 0b11,  # areas 2 and 3 are checked as soon as they are more than nothing
    "1420": 12000.0,
    "1430": 8000.0,
    "1660": 2000.0,
    "3772": 0.0,
}
_X = _SLIDE | {"1006": 0b1000, "1022": 1, "1320": 640.0, "1321": -640.0}
_Z = _SLIDE | {"1022": 3, "1320": 400.0, "1321": -800.0, "1420": 15000.0}
_TOOL = _ROTARY | {"3772": 4000.0, "1320": _FAR, "1321": -_FAR}
_WORK = _ROTARY | {"3772": 2000.0, "1320": _FAR, "1321": -_FAR}
_TILTED_Y = _SLIDE | {"1022": 2, "1320": 320.0, "1321": -320.0}
_COMMON: dict[int, float] = {
    201: 0,
    198: 4,
    199: 2,
    1300: 0,
    1301: 0,
    1410: 2000,
    3401: 1,
    3410: 0.01,
    8200: 0,
    8201: 0,
    8209: 0,
    9001: 4,
    9003: -1,
    **{row[0]: 0 for row in _SWITCH_ROWS},
}
_DELIVERED: dict[str, tuple[dict[int, float], dict[str, dict[str, float]]]] = {
    "hobbing": (
        _COMMON | {197: 3, 8210: 0, 8211: 0, 8212: 0, 9002: 3},
        {"X": _X, "Z": _Z, "Y": _TOOL, "C": _WORK},
    ),
    "tilted": (
        _COMMON | {197: 5, 8210: -30000, 8211: 3, 8212: 1, 9002: 5},
        {"X": _X, "Z": _Z, "Y": _TILTED_Y, "C": _WORK, "B": _TOOL},
    ),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameters:
    """A full set of parameter values. Axis values are keyed by the delivered axis letter."""

    setup: str
    letters: tuple[str, ...]
    """delivered axis letters in system axis order"""
    values: Mapping[tuple[int, str], float]
    """(number, axis letter or "") -> value; bits as the whole byte"""

    def number(self, number: int, axis: str = "") -> float:
        """The value of a parameter."""
        return self.values[number, axis]

    def integer(self, number: int, axis: str = "") -> int:
        """The value of an integer parameter."""
        return int(self.values[number, axis])

    def bit(self, number: int, bit: int, axis: str = "") -> bool:
        """One bit of a bit parameter."""
        return bool(int(self.values[number, axis]) >> bit & 1)


def delivered(setup: str = "hobbing", overrides: Mapping[str, Value] | None = None) -> Parameters:
    """The delivered parameters of a set-up, with overrides such as {"201#4": "1", "1320.Z": 250.0}.

    Raises ControllerError for an unknown set-up, parameter, bit or axis and for a value out of range.
    """
    if setup not in _DELIVERED:
        raise ControllerError(f"unknown set-up {setup!r}", remedy=" or ".join(SETUPS))
    common, axes = _DELIVERED[setup]
    values: dict[tuple[int, str], float] = {(number, ""): value for number, value in common.items()}
    for letter, axis in axes.items():
        values |= {(int(number), letter): value for number, value in axis.items()}
        values[1020, letter] = ord(letter)
    letters = tuple(axes)
    for key, value in (overrides or {}).items():
        _override(values, letters, key, value)
    return Parameters(setup=setup, letters=letters, values=values)


_KEY = re.compile(r"(\d{1,5})(?:#(\d))?(?:\.([A-Z]))?", re.ASCII)


def _override(values: dict[tuple[int, str], float], letters: tuple[str, ...], key: str, value: Value) -> None:
    found = _KEY.fullmatch(key.strip())
    if not found:
        raise ControllerError(
            f"{key!r} names no parameter", remedy="a number, #bit, .axis, as in 201#4 or 1320.Z"
        )
    number, bit, axis = int(found.group(1)), found.group(2), found.group(3) or ""
    entry = PARAMETERS.get(number)
    if entry is None:
        raise ControllerError(f"unknown parameter {number}", remedy=_numbers())
    if entry.per_axis and axis not in letters:
        raise ControllerError(f"{key}: parameter {number} belongs to an axis", remedy=_keys(entry, letters))
    if not entry.per_axis and axis:
        raise ControllerError(f"{key}: parameter {number} belongs to no axis", remedy=_keys(entry, letters))
    if entry.kind is ParameterKind.BITS:
        if bit is None or int(bit) not in entry.bits:
            raise ControllerError(
                f"{key}: parameter {number} is set bit by bit", remedy=_keys(entry, letters)
            )
        on = _parsed(entry, key, value)
        mask = 1 << int(bit)
        before = int(values[number, axis])
        values[number, axis] = before | mask if on else before & ~mask
    elif bit is not None:
        raise ControllerError(f"{key}: parameter {number} has no bits", remedy=_keys(entry, letters))
    else:
        values[number, axis] = _parsed(entry, key, value)


def _numbers() -> str:
    """All numbers of the table, neighbours as a range."""
    runs: list[list[int]] = []
    for number in sorted(PARAMETERS):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ", ".join(f"{run[0]}-{run[-1]}" if len(run) > 1 else str(run[0]) for run in runs)


def _keys(entry: ParameterEntry, letters: tuple[str, ...]) -> str:
    heads = [f"{entry.number}#{bit}" for bit in entry.bits] or [str(entry.number)]
    return (
        ", ".join(f"{head}.{letter}" for head in heads for letter in letters)
        if entry.per_axis
        else ", ".join(heads)
    )


def _parsed(entry: ParameterEntry, key: str, value: Value) -> float:
    """The value as a number of the table's unit, or a message that names the range."""
    text = str(value).strip()
    valid = f"{entry.low:g} to {entry.high:g} {entry.unit}".strip()
    if entry.kind is ParameterKind.ANGLE_COUNT:
        valid += f", or with a point {entry.low / 1000.0:g}. to {entry.high / 1000.0:g}. deg"
    if entry.kind is ParameterKind.LETTER and len(text) == 1 and text.isalpha():
        return ord(text.upper())
    try:
        number = float(int(value)) if isinstance(value, bool) else float(text)
    except ValueError:
        raise ControllerError(f"parameter {key} = {text!r} is no number", remedy=valid) from None
    if entry.kind is ParameterKind.ANGLE_COUNT and "." in text:
        number = round(number * 1000.0)
    if not entry.low <= number <= entry.high:
        raise ControllerError(f"parameter {key} = {text} is out of range", remedy=valid)
    if entry.kind is not ParameterKind.REAL and number != int(number):
        raise ControllerError(f"parameter {key} = {text} is no integer", remedy=valid)
    return number
