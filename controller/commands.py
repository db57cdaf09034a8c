"""Typed commands: what one checked block asks of the motion. Axes by column, lengths in slide millimetres
(a diameter axis in radius), angles in degrees, speeds in rpm."""

from collections.abc import Mapping
from dataclasses import dataclass

from controller.laws.gearbox import GearBox
from controller.span import Span


@dataclass(frozen=True, slots=True, kw_only=True)
class Feed:
    """The feed of a cutting move."""

    value: float
    """[mm/s | deg/s], or per revolution of the work [mm | deg]"""
    per_revolution: bool = False
    measured: bool = False
    """per revolution by the measured speed of the work axis (parameter 201#2 = 0, and always out of sync)"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Move:
    """G00 (`feed` None) or G01 to absolute and by incremental positions, Cartesian."""

    absolute: Mapping[int, float]
    incremental: Mapping[int, float]
    feed: Feed | None
    places: Mapping[int, int]
    """axis column -> text column, from 1, of the word that commanded it"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Arc:
    """G02, G03: a circular arc at feed; axes outside the plane go along in proportion (helix)."""

    absolute: Mapping[int, float]
    incremental: Mapping[int, float]
    plane: tuple[int, int]
    """columns of the first and the second axis: Z X of G18, X Y of G17, Y Z of G19"""
    centre: tuple[float, float]
    """from the start point, in plane order [mm]"""
    clockwise: bool
    """G02, looking against the third axis of the right-handed plane"""
    feed: Feed
    places: Mapping[int, int]
    """axis column -> text column of its word"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Thread:
    """G32: straight and bound to the angle of the work spindle; no override, no feed hold."""

    absolute: Mapping[int, float]
    incremental: Mapping[int, float]
    lead: float
    """[mm per turn] along the axis that travels furthest"""
    start_angle: float = 0.0
    """Q: spindle angle at which the cut begins [deg]"""
    places: Mapping[int, int]


@dataclass(frozen=True, slots=True, kw_only=True)
class Skip:
    """G31: a straight move at feed that ends early when the skip signal comes; #5061 ff. hold where."""

    move: Move


@dataclass(frozen=True, slots=True, kw_only=True)
class MachineMove:
    """G53: rapid to slide positions."""

    target: Mapping[int, float]
    places: Mapping[int, int]
    """axis column -> text column of its word"""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceReturn:
    """G28, G30 from the intermediate point, M19: the axes go to their reference points."""

    axes: tuple[int, ...]
    span: Span
    point: int = 1
    """1 to 4"""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceCheck:
    """G27, after its positioning: the axes must stand on their first reference points."""

    axes: tuple[int, ...]
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class StrokeCheck:
    """G22 and G23: stored stroke limit 2 on, its area changed or not, and off."""

    on: bool
    area: Mapping[int, tuple[float, float]] | None = None
    """column -> lower and upper bound, machine coordinates as slide travel [mm]; None = as it is"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Dwell:
    """G04."""

    seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Couple:
    """G81, G51.2: engage the gear box, or engage it anew."""

    gear: GearBox
    phase: float = 0.0
    """R of G51.2: the master turns by so much first [deg]"""
    normal_module: float | None = None
    """Q of G81 [mm]; of a diametral pitch the module that goes with it"""
    helix_angle: float | None = None
    """P of G81 [deg], + right-hand"""
    lead: float = 0.0
    """A of G51.2 [mm per turn of the work], + right-hand; 0 = straight"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Uncouple:
    """G80, G50.2."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SpindleSpeed:
    """An axis turns at a speed [rpm], signed; `wait` for it to be reached (S0, M05)."""

    axis: int
    rpm: float
    wait: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceSpeed:
    """G96: the work spindle keeps a surface speed at the programmed diameter of X."""

    axis: int
    speed: float
    """[m/min], signed by M03 or M04"""
    clamp: float
    """[rpm]"""
    radial: int
    """column of X"""


@dataclass(frozen=True, slots=True, kw_only=True)
class SetCoordinates:
    """G50 X Z: the absolute positions become these."""

    absolute: Mapping[int, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class ShiftCoordinates:
    """G54-G59, T: the zero point moves by so much; absolute positions shrink by it."""

    shift: Mapping[int, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class SelectTool:
    """T: this tool is in use from now on."""

    number: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ClearTable:
    """G10 L60 Q: a new table of corrections against the work angle, all nought."""

    points: int
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class SetTablePoint:
    """G10 L60 P: the corrections at one of its points."""

    number: int
    """from 1"""
    values: Mapping[int, float]
    """column -> correction [mm slide travel | deg]"""
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class SwitchTable:
    """G10 L61, L62: the table comes into force, or goes out of it."""

    on: bool
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class Coolant:
    """M08, M09."""

    on: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgramStop:
    """M00, M01 with the optional-stop signal, #3006."""

    span: Span
    message: str = ""
    """of #3006"""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgramEnd:
    """M30, M02, or the end of the text: spindles stop, then the program is finished."""


Command = (
    Move
    | Arc
    | Thread
    | Skip
    | MachineMove
    | ReferenceReturn
    | ReferenceCheck
    | StrokeCheck
    | Dwell
    | Couple
    | Uncouple
    | SpindleSpeed
    | SurfaceSpeed
    | SetCoordinates
    | ShiftCoordinates
    | SelectTool
    | ClearTable
    | SetTablePoint
    | SwitchTable
    | Coolant
    | ProgramStop
    | ProgramEnd
)
