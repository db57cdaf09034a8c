"""What the parameters say about the machine: axes, spindles and the inclined pair, checked once at start."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from controller.laws.inclined import InclinedPair, in_dead_band
from controller.tables.alarms import alarm
from controller.tables.parameter_table import SWITCHES
from controller.tables.parameters import Parameters

INCREMENT_LETTER = {"X": "U", "Z": "W", "Y": "V", "C": "H"}
"""axis letter -> letter of its increments (rulings, section 1, Addresses)"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Axis:
    """One axis. Lengths are slide travel: a diameter axis in radius."""

    letter: str
    number: int
    """system axis number, from 1"""
    rotary: bool
    type_a: bool
    """rotary axis whose displays count modulo 360°"""
    diameter: bool
    references: tuple[float, ...]
    """first to fourth reference point [mm | deg] (parameters 1240 to 1243)"""
    upper: float
    """stroke limit 1 [mm]"""
    lower: float
    area_2: tuple[float, float] | None
    """stroke limit 2: lower and upper bound [mm]; None = the axis has no part in it (1310#0 = 0)"""
    area_3: tuple[float, float] | None
    """stroke limit 3: lower and upper bound [mm]; None = the axis has no part in it (1310#1 = 0)"""
    rapid: float
    """[mm/s | deg/s]"""
    cutting: float
    """highest feed [mm/s | deg/s]"""
    acceleration: float
    """[mm/s² | deg/s²]"""
    spindle_max: float
    """highest speed as a spindle [rpm]; 0 = none"""
    analogue: bool = False
    """turns by S alone, without position control (parameter 9005#0)"""
    encoder: bool = True
    """its position and speed are measured (parameter 9005#1)"""

    @property
    def factor(self) -> float:
        """Programmed units per unit of slide travel: 2 for a diameter axis."""
        return 2.0 if self.diameter else 1.0

    @property
    def reference(self) -> float:
        """First reference point [mm | deg]."""
        return self.references[0]


@dataclass(frozen=True, slots=True, kw_only=True)
class PositionSwitch:
    """Signal PSWnn: on while a slide stands in a range (parameters 6910 to 6965; inclined axis, 注意 9)."""

    number: int
    """1 to 16"""
    axis: int
    """column"""
    lower: float
    """[mm | deg] slide travel"""
    upper: float


@dataclass(frozen=True, slots=True, kw_only=True)
class MachineData:
    """The axes in system order and the functions set on them."""

    axes: tuple[Axis, ...]
    pair: InclinedPair | None
    """the inclined pair, where 8200#0 = 1 and its angle does not switch it off"""
    pair_angle_off: float | None
    """[deg] the angle that switched the function off"""
    work_spindle: int | None
    """column (parameter 9001); None where that is no rotary axis"""
    tool_spindle: int | None
    """column (parameter 9002)"""
    position_switches: tuple[PositionSwitch, ...]
    """those that have an axis"""
    parameters: Parameters
    basic: Mapping[str, int]
    """X, Y, Z -> column of the linear axis that is it (parameter 1022)"""
    together: int
    """most axes that one block may move together (parameter 9004)"""

    @property
    def letters(self) -> tuple[str, ...]:
        """Axis letters in system order."""
        return tuple(axis.letter for axis in self.axes)

    def column_of_number(self, number: int) -> int | None:
        """Column of a system axis number; None where the machine has no such axis."""
        return number - 1 if 1 <= number <= len(self.axes) else None


def machine_data(parameters: Parameters) -> MachineData:
    """Read the machine from its parameters. Raises AlarmError HT9005 where they contradict each other."""
    axes = tuple(_axis(parameters, k, letter) for k, letter in enumerate(parameters.letters))
    letters = [axis.letter for axis in axes]
    taken = set("FGIKLMNOPQRST")
    for k, letter in enumerate(letters):
        if letter in letters[:k] or letter in taken or letter in INCREMENT_LETTER.values():
            raise alarm(
                "HT9005", f"1020.{parameters.letters[k]} = {letter}", valid="X, Y, Z, A, B or C, each once"
            )
    if parameters.integer(9003) == 0:
        raise alarm("HT9005", "parameter 9003 = 0", valid="1 or -1")
    pair, off = _inclined_pair(parameters, axes)
    return MachineData(
        axes=axes,
        pair=pair,
        pair_angle_off=off,
        work_spindle=_rotary_column(axes, parameters.integer(9001)),
        tool_spindle=_rotary_column(axes, parameters.integer(9002)),
        position_switches=_position_switches(parameters, axes),
        parameters=parameters,
        basic=_basic_axes(parameters, axes),
        together=parameters.integer(9004),
    )


def _basic_axes(parameters: Parameters, axes: tuple[Axis, ...]) -> dict[str, int]:
    basic: dict[str, int] = {}
    for column, delivered in enumerate(parameters.letters):
        number = parameters.integer(1022, delivered)
        if number and not axes[column].rotary:
            basic.setdefault("XYZ"[number - 1], column)
    return basic


def _rotary_column(axes: tuple[Axis, ...], number: int) -> int | None:
    return number - 1 if number <= len(axes) and axes[number - 1].rotary else None


def _axis(parameters: Parameters, column: int, letter: str) -> Axis:
    rotary = parameters.bit(1006, 0, letter)
    diameter = parameters.bit(1006, 3, letter) and not rotary
    factor = 2.0 if diameter else 1.0
    upper, lower = parameters.number(1320, letter) / factor, parameters.number(1321, letter) / factor
    if upper <= lower:
        raise alarm(
            "HT9005", f"1320.{letter} not above 1321.{letter}", valid="a plus limit above the minus limit"
        )
    analogue = parameters.bit(9005, 0, letter)
    if analogue and not rotary:
        valid = "a rotary axis as analogue spindle"
        raise alarm("HT9005", f"9005#0.{letter} = 1, a linear axis", valid=valid)
    return Axis(
        letter=chr(parameters.integer(1020, letter)),
        number=column + 1,
        rotary=rotary,
        type_a=rotary and not parameters.bit(1006, 1, letter),
        diameter=diameter,
        references=tuple(parameters.number(number, letter) / factor for number in (1240, 1241, 1242, 1243)),
        upper=math.inf if rotary else upper,
        lower=-math.inf if rotary else lower,
        area_2=None if rotary else _area(parameters, letter, bit=0, plus=1322, factor=factor),
        area_3=None if rotary else _area(parameters, letter, bit=1, plus=1324, factor=factor),
        rapid=parameters.number(1420, letter) / 60.0,
        cutting=parameters.number(1430, letter) / 60.0,
        acceleration=parameters.number(1660, letter),
        spindle_max=parameters.number(3772, letter) if rotary else 0.0,
        analogue=analogue,
        encoder=parameters.bit(9005, 1, letter),
    )


def _area(
    parameters: Parameters, letter: str, *, bit: int, plus: int, factor: float
) -> tuple[float, float] | None:
    """Bounds of stroke limit 2 or 3 on one axis; equal ones are kept: G22 may give the axis an area."""
    if not parameters.bit(1310, bit, letter):
        return None
    lower, upper = parameters.number(plus + 1, letter), parameters.number(plus, letter)
    if upper < lower:
        raise alarm(
            "HT9005",
            f"{plus}.{letter} = {upper:g} below {plus + 1}.{letter} = {lower:g}",
            valid="the plus side at or above the minus side; equal = no area",
        )
    return lower / factor, upper / factor


def _position_switches(parameters: Parameters, axes: tuple[Axis, ...]) -> tuple[PositionSwitch, ...]:
    found: list[PositionSwitch] = []
    for number in range(1, SWITCHES + 1):
        axis = parameters.integer(6909 + number)
        if axis == 0:
            continue
        if axis > len(axes):
            raise alarm("HT9005", f"{6909 + number} = {axis}, no axis", valid=f"0 to {len(axes)}")
        lower, upper = parameters.number(6949 + number), parameters.number(6929 + number)
        if lower > upper:
            valid = "the upper end at or above the lower"
            raise alarm(
                "HT9005", f"{6929 + number} = {upper:g} below {6949 + number} = {lower:g}", valid=valid
            )
        factor = axes[axis - 1].factor
        found.append(PositionSwitch(number=number, axis=axis - 1, lower=lower / factor, upper=upper / factor))
    return tuple(found)


def _inclined_pair(
    parameters: Parameters, axes: tuple[Axis, ...]
) -> tuple[InclinedPair | None, float | None]:
    """The pair of 8211 and 8212, looked at only when 8200#0 = 1 (rulings, section 4).

    Both axes count in the same unit, as they must (注意 6): G20 and G21 hold for all axes alike.
    """
    if not parameters.bit(8200, 0):
        return None, None
    inclined, orthogonal = parameters.integer(8211), parameters.integer(8212)
    if not (1 <= inclined <= len(axes) and 1 <= orthogonal <= len(axes)) or inclined == orthogonal:
        raise alarm(
            "HT9005",
            f"8211 = {inclined}, 8212 = {orthogonal} with 8200#0 = 1: one clause of the original takes X and "
            "Z then, another switches the function off",
            valid=f"two different system axis numbers, 1 to {len(axes)}",
        )
    for number, column in ((8211, inclined), (8212, orthogonal)):
        if axes[column - 1].rotary:
            raise alarm("HT9005", f"{number} = {column}, a rotary axis", valid="linear axes")
    angle = parameters.number(8210) / 1000.0
    if in_dead_band(angle):
        return None, angle
    return InclinedPair(inclined=inclined - 1, orthogonal=orthogonal - 1, angle=angle), None
