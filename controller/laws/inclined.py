"""The inclined-axis law (988TD 倾斜轴, section 一 各轴的移动量; rulings, section 4).

Cartesian (program) coordinates p, slide coordinates a, inclined axis y, orthogonal axis x, angle θ, radius:
y_a = y_p / cos θ,  x_a = x_p − y_p tan θ.  The factor C of the original is the ratio of the diameter factors
of the two axes and drops out in radius.
"""

import math
from dataclasses import dataclass
from enum import Enum

DEAD_BAND = (85.0, 95.0)
"""[deg] an angle whose magnitude lies here switches the function off (parameter 8210, 数据范围)"""


class Frame(Enum):
    """Coordinates in which a limit or a signal is meant (section 二, 存储行程极限, 信号之间的关系)."""

    SLIDES = "slide"
    CARTESIAN = "Cartesian"


@dataclass(frozen=True, slots=True, kw_only=True)
class InclinedPair:
    """Which axis stands inclined to which, and by how much."""

    inclined: int
    """column of the inclined axis (parameter 8211)"""
    orthogonal: int
    """column of the orthogonal axis (parameter 8212)"""
    angle: float
    """θ [deg] (parameter 8210)"""

    def to_slides(self, x: float, y: float, *, compensated: bool = True) -> tuple[float, float]:
        """Orthogonal and inclined slide travel of a Cartesian travel `x` along the orthogonal and `y` along
        the inclined axis [mm]. `compensated=False` is signal NOZAGC = 1: the orthogonal slide stays out."""
        angle = math.radians(self.angle)
        return (x - y * math.tan(angle) if compensated else x), y / math.cos(angle)

    def to_cartesian(self, x: float, y: float) -> tuple[float, float]:
        """Cartesian travel along the orthogonal and the inclined axis of the slides' travels [mm]."""
        angle = math.radians(self.angle)
        return x + y * math.sin(angle), y * math.cos(angle)


def in_dead_band(angle: float) -> bool:
    """Whether the angle [deg] switches the function off."""
    return DEAD_BAND[0] <= abs(angle) <= DEAD_BAND[1]


def manual_return(pair: InclinedPair | None, axis: int, way: float, *, azr: bool) -> dict[int, float]:
    """Slide travels by column of a manual reference return whose own slide goes `way` [mm | deg].

    AZR 8200#2 = 0: the return of the inclined axis moves the orthogonal one, too, so that the tool goes along
    the inclined axis alone; 1: it does not (手动参考点返回操作; the rulings mend its misprints).
    """
    if pair is None or axis != pair.inclined or azr:
        return {axis: way}
    _, along = pair.to_cartesian(0.0, way)
    return dict(zip((pair.orthogonal, pair.inclined), pair.to_slides(0.0, along), strict=True))
