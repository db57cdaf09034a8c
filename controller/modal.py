"""The modal state between blocks: replaced as a whole when a block has been checked."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from controller.codes import POWER_ON, Group
from controller.gearbox import GearBox


@dataclass(frozen=True, slots=True, kw_only=True)
class Modal:
    """What the next block inherits."""

    codes: Mapping[Group, int] = field(default_factory=lambda: dict(POWER_ON))
    """the G code in force of each group, in tenths"""
    feed: float | None = None
    """F in programmed units; None until an F stands since the last G98 or G99"""
    feed_inch: bool = False
    """whether `feed` counts inches"""
    rpm: float = 0.0
    """S of G97, out of sync [rpm]"""
    surface_speed: float = 0.0
    """S of G96 [m/min]"""
    clamp: float = math.inf
    """G50 S [rpm]"""
    direction: int = 0
    """work spindle out of sync: 1 M03, -1 M04, 0 M05"""
    tool: int = 0
    tool_offset: int | None = None
    """None: that of the mounted tool, until the first T"""
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
    def constant_surface_speed(self) -> bool:
        """G96."""
        return self.codes[Group.SPINDLE] == 960
