"""The tables of G and M codes: G-code system A of a 988TD-class lathe.

One row a code: its group (one code of a group in a block), whether the twin runs it, and its clause. A G code
is keyed by its number in tenths: G50.2 is 502.
"""

from dataclasses import dataclass
from enum import Enum


class Group(Enum):
    """Modal groups. Of one group a block holds at most one code."""

    ONE_SHOT = "00"
    MOTION = "01"
    SPINDLE = "02"
    STROKE_CHECK = "04"
    FEED = "05"
    UNIT = "06"
    NOSE_RADIUS = "07"
    HOBBING = "10"
    MACRO = "12"
    WORK_OFFSET = "14"
    EXACT_STOP = "15"
    PLANE = "16"
    POLYGON = "20"
    POLAR = "21"


class Support(Enum):
    """What the twin does with a code."""

    RUNS = "runs"
    NEVER = "not supported by the twin"


@dataclass(frozen=True, slots=True, kw_only=True)
class GCode:
    """One row of the G-code table."""

    tenths: int
    """the number in tenths"""
    group: Group
    support: Support
    meaning: str
    clause: str

    @property
    def name(self) -> str:
        """As a programmer writes it: G01, G50.2."""
        return g_name(self.tenths)

    @property
    def instead(self) -> str:
        """What to write where the twin does not run the code."""
        return _INSTEAD.get(self.tenths, "a program without it; the cuts written out as G00 to G03")


def g_name(tenths: int) -> str:
    """The usual spelling of a G code: 10 -> G01, 502 -> G50.2."""
    whole, tenth = divmod(tenths, 10)
    return f"G{whole:02d}" + (f".{tenth}" if tenth else "")


_RULINGS = "rulings, section 1"
_HOBBING = "hobbing, 指令格式"
_POLYGON = "polygon, 代码格式"
_LANGUAGE = "GSK 988TA/TB manual, G codes"

_ROWS = (
    (0, "01", "RUNS", "positioning at rapid, linear", _RULINGS),
    (10, "01", "RUNS", "linear interpolation", _RULINGS),
    (20, "01", "RUNS", "circular interpolation clockwise", _RULINGS),
    (30, "01", "RUNS", "circular interpolation counter-clockwise", _RULINGS),
    (320, "01", "RUNS", "thread cutting", _RULINGS),
    (340, "01", "NEVER", "variable-lead thread cutting", _LANGUAGE),
    (900, "01", "RUNS", "outer or inner turning cycle", _RULINGS),
    (920, "01", "RUNS", "threading cycle", _RULINGS),
    (940, "01", "RUNS", "facing cycle", _RULINGS),
    (40, "00", "RUNS", "dwell", _RULINGS),
    (71, "00", "NEVER", "cylindrical interpolation", _LANGUAGE),
    (100, "00", "RUNS", "offset data setting; L60 to L62: table against the work angle", _RULINGS),
    (110, "00", "RUNS", "offset data setting off", _LANGUAGE),
    (270, "00", "RUNS", "reference return check", _RULINGS),
    (280, "00", "RUNS", "return to the reference point", _RULINGS),
    (300, "00", "RUNS", "return to the 2nd, 3rd, 4th reference point", _RULINGS),
    (310, "00", "RUNS", "skip", _RULINGS),
    (360, "00", "NEVER", "automatic tool offset X", _LANGUAGE),
    (370, "00", "NEVER", "automatic tool offset Z", _LANGUAGE),
    (500, "00", "RUNS", "coordinate setting, spindle speed clamp", _RULINGS),
    (520, "00", "RUNS", "local coordinate system", _RULINGS),
    (530, "00", "RUNS", "machine coordinates", "inclined axis, 选择机械坐标 (G53)"),
    (650, "00", "RUNS", "macro call", _RULINGS),
    (700, "00", "RUNS", "finishing cycle", _RULINGS),
    (710, "00", "RUNS", "roughing cycle along Z", _RULINGS),
    (720, "00", "RUNS", "roughing cycle along X", _RULINGS),
    (730, "00", "RUNS", "pattern repeating", _RULINGS),
    (740, "00", "RUNS", "peck drilling along Z", _RULINGS),
    (750, "00", "RUNS", "grooving along X", _RULINGS),
    (760, "00", "RUNS", "multiple threading cycle", _RULINGS),
    (960, "02", "RUNS", "constant surface speed: S in m/min, in inch input ft/min", _RULINGS),
    (970, "02", "RUNS", "spindle speed in rpm", _RULINGS),
    (220, "04", "RUNS", "stored stroke check 2 on", _RULINGS),
    (230, "04", "RUNS", "stored stroke check 2 off", _RULINGS),
    (980, "05", "RUNS", "feed per minute", _RULINGS),
    (990, "05", "RUNS", "feed per revolution", _RULINGS),
    (200, "06", "RUNS", "inch input", _RULINGS),
    (210, "06", "RUNS", "metric input", _RULINGS),
    (400, "07", "RUNS", "tool-nose radius compensation off", _RULINGS),
    (410, "07", "NEVER", "tool-nose radius compensation left", _RULINGS),
    (420, "07", "NEVER", "tool-nose radius compensation right", _RULINGS),
    (800, "10", "RUNS", "hobbing synchronisation off", _HOBBING),
    (810, "10", "RUNS", "hobbing synchronisation on", _HOBBING),
    (830, "10", "NEVER", "face drilling cycle", _LANGUAGE),
    (840, "10", "NEVER", "face tapping cycle", _LANGUAGE),
    (850, "10", "NEVER", "face boring cycle", _LANGUAGE),
    (870, "10", "NEVER", "side drilling cycle", _LANGUAGE),
    (880, "10", "NEVER", "side tapping cycle", _LANGUAGE),
    (890, "10", "NEVER", "side boring cycle", _LANGUAGE),
    (660, "12", "RUNS", "modal macro call", _RULINGS),
    (670, "12", "RUNS", "modal macro call off", _RULINGS),
    (540, "14", "RUNS", "work coordinate system 1", _RULINGS),
    (550, "14", "RUNS", "work coordinate system 2", _RULINGS),
    (560, "14", "RUNS", "work coordinate system 3", _RULINGS),
    (570, "14", "RUNS", "work coordinate system 4", _RULINGS),
    (580, "14", "RUNS", "work coordinate system 5", _RULINGS),
    (590, "14", "RUNS", "work coordinate system 6", _RULINGS),
    (610, "15", "RUNS", "exact stop", _RULINGS),
    (640, "15", "RUNS", "cutting mode", _RULINGS),
    (170, "16", "RUNS", "plane X Y", _RULINGS),
    (180, "16", "RUNS", "plane Z X", _RULINGS),
    (190, "16", "RUNS", "plane Y Z", _LANGUAGE),
    (502, "20", "RUNS", "polygon turning off", _POLYGON),
    (512, "20", "RUNS", "polygon turning on", _POLYGON),
    (121, "21", "NEVER", "polar coordinate interpolation on", _LANGUAGE),
    (131, "21", "RUNS", "polar coordinate interpolation off", _LANGUAGE),
)

G_CODES: dict[int, GCode] = {
    tenths: GCode(tenths=tenths, group=Group(group), support=Support[support], meaning=meaning, clause=clause)
    for tenths, group, support, meaning, clause in _ROWS
}
"""Every G code of the controller, by its number in tenths."""

_INSTEAD = {
    71: "C moves written out, as G01 Z C",
    121: "X and C moves written out, as G01 X C",
    340: "G32 with a constant lead F",
    360: "the offset by G10 P X",
    370: "the offset by G10 P Z",
    410: "G40, and the contour programmed for the tool centre or with offsets",
    420: "G40, and the contour programmed for the tool centre or with offsets",
    830: "G74, or the hole written out as G01 and G00",
    870: "G75, or the hole written out as G01 and G00",
}


def nearest_names(number: float, count: int = 6) -> str:
    """The G codes that the twin runs nearest to a number, for messages: "G50, G50.2, ..."."""
    running = [code for code in G_CODES.values() if code.support is Support.RUNS]
    nearest = sorted(running, key=lambda code: abs(code.tenths / 10 - number))[:count]
    return ", ".join(code.name for code in sorted(nearest, key=lambda code: code.tenths))


POWER_ON: dict[Group, int] = {
    G_CODES[code].group: code for code in (0, 970, 980, 180, 210, 230, 400, 540, 640, 670, 800, 502, 131)
}
"""The modal state at power-on (rulings, section 0)."""


class Moment(Enum):
    """When in its block an M code acts."""

    BEFORE_MOTION = "before the motion of the block"
    AFTER_MOTION = "after the motion of the block"


@dataclass(frozen=True, slots=True, kw_only=True)
class MCode:
    """One row of the M-code table."""

    number: int
    moment: Moment
    meaning: str

    @property
    def name(self) -> str:
        """As a programmer writes it: M03."""
        return f"M{self.number:02d}"


M_CODES: dict[int, MCode] = {
    number: MCode(number=number, moment=Moment[moment], meaning=meaning)
    for number, moment, meaning in (
        (0, "AFTER_MOTION", "program stop"),
        (1, "AFTER_MOTION", "optional stop"),
        (2, "AFTER_MOTION", "end of program"),
        (3, "BEFORE_MOTION", "work spindle in the positive sense; not in sync"),
        (4, "BEFORE_MOTION", "work spindle in the negative sense; not in sync"),
        (5, "AFTER_MOTION", "work spindle stop; in sync the same as S0"),
        (8, "BEFORE_MOTION", "coolant on"),
        (9, "AFTER_MOTION", "coolant off"),
        (19, "BEFORE_MOTION", "work spindle to its reference and into position control"),
        (30, "AFTER_MOTION", "end of program, rewind"),
        (98, "AFTER_MOTION", "subprogram call"),
        (99, "AFTER_MOTION", "return from a subprogram"),
    )
}
"""Every M code of the machine (rulings, section 1)."""
