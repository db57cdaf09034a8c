"""The modal state between blocks: replaced as a whole when a block has been checked."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from controller.laws.gearbox import GearBox
from controller.tables.codes import POWER_ON, Group

METRES_PER_FOOT = 0.3048


@dataclass(frozen=True, slots=True, kw_only=True)
class SingleCycle:
    """What G90, G92, G94 keep from block to block, in slide travel [mm]."""

    end: Mapping[int, tuple[float, bool]] = field(default_factory=dict)
    """column -> programmed end, and whether that is an increment from the start point"""
    taper: float = 0.0
    """R: start of the cut minus its end, across the direction of the cut"""


@dataclass(frozen=True, slots=True, kw_only=True)
class CycleData:
    """What the first blocks of G71 to G76 set; None until one has."""

    depth: float | None = None
    """U of G71, W of G72: depth of cut [mm]"""
    escape: float | None = None
    """R of G71, G72 [mm]"""
    relief: tuple[float, float] | None = None
    """U, W of G73: X and Z from the first to the last pass [mm]"""
    divisions: int | None = None
    """R of G73"""
    peck_return: float | None = None
    """R of G74, G75 [mm]"""
    spring_passes: int | None = None
    """P of G76, first two digits: passes at full depth"""
    chamfer: float | None = None
    """P of G76, middle digits: run-out in leads"""
    thread_angle: float | None = None
    """P of G76, last two digits: angle of the tool tip [deg]"""
    smallest_depth: float | None = None
    """Q of G76 [mm]"""
    allowance: float | None = None
    """R of G76: finishing allowance [mm]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class ModalCall:
    """G66: the macro that every block with motion calls."""

    number: int
    repeats: int
    arguments: Mapping[int, float]
    """number of the local variable -> value"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Modal:
    """What the next block inherits."""

    codes: Mapping[Group, int] = field(default_factory=lambda: dict(POWER_ON))
    """the G code in force of each group, in tenths"""
    feed: float | None = None
    """F in programmed units; None until an F stands since the last G98 or G99"""
    feed_inch: bool = False
    """whether `feed` counts inches"""
    lead: float | None = None
    """F of the last thread [mm per turn]"""
    rpm: float = 0.0
    """S of G97, out of sync [rpm]"""
    surface_speed: float = 0.0
    """S of G96 in programmed units"""
    surface_inch: bool = False
    """whether `surface_speed` counts feet per minute, else metres"""
    clamp: float = math.inf
    """G50 S [rpm]"""
    direction: int = 0
    """work spindle out of sync: 1 M03, -1 M04, 0 M05"""
    m_code: int | None = None
    """the last M code"""
    tool: int = 0
    tool_offset: int | None = None
    """None: that of the mounted tool, until the first T"""
    tool_shift: Mapping[int, float] = field(default_factory=dict)
    """the tool offset as it was taken: column -> slide travel [mm | deg]"""
    tool_moved: Mapping[int, float] = field(default_factory=dict)
    """the part of it that the axes have moved by, as parameter 5002 says"""
    local_shift: Mapping[int, float] = field(default_factory=dict)
    """G52: column -> slide travel [mm | deg]"""
    single: SingleCycle = field(default_factory=SingleCycle)
    cycles: CycleData = field(default_factory=CycleData)
    call: ModalCall | None = None
    gear: GearBox | None = None
    """the gear box in force"""
    sync_rpm: float = 0.0
    """S in sync, signed [rpm]"""

    @property
    def inch(self) -> bool:
        """G20."""
        return self.codes[Group.UNIT] == 200

    @property
    def per_revolution(self) -> bool:
        """G99."""
        return self.codes[Group.FEED] == 990

    @property
    def surface_metres(self) -> float:
        """S of G96 [m/min]: feet per minute in inch input (Fanuc lathe manuals, G96: m/min or feet/min)."""
        return self.surface_speed * (METRES_PER_FOOT if self.surface_inch else 1.0)

    @property
    def constant_surface_speed(self) -> bool:
        """G96."""
        return self.codes[Group.SPINDLE] == 960
