"""The inclined-axis law (988TD 倾斜轴, section 一 各轴的移动量; rulings, section 4).

Cartesian (program) coordinates p, slide coordinates a, inclined axis y, orthogonal axis x, angle θ, radius:
y_a = y_p / cos θ,  x_a = x_p − y_p tan θ.  The factor C of the original is the ratio of the diameter factors
of the two axes and drops out in radius.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
DEAD_BAND = (85.0, 95.0)
"""[deg] an angle whose magnitude lies here switches the function off (parameter 8210, 数据范围)"""


@dataclass(frozen=True, slots=True, kw_only=True)
class InclinedPair:
    """Which axis stands inclined to which, and by how much."""

    inclined: int
    """column of the inclined axis (parameter 8211)"""
    orthogonal: int
    """column of the orthogonal axis (parameter 8212)"""
    angle: float
    """θ [deg] (parameter 8210)"""


def in_dead_band(angle: float) -> bool:
    """Whether the angle [deg] switches the function off."""
    return DEAD_BAND[0] <= abs(angle) <= DEAD_BAND[1]


def slides_from_cartesian(axes: int, pair: InclinedPair | None, *, compensated: bool = True) -> Floats:
    """Matrix (axes, axes) that takes a Cartesian displacement to slide displacements.

    `compensated=False` is signal NOZAGC = 1: the orthogonal slide stays out of it (信号 G63.5).
    """
    matrix = np.eye(axes)
    if pair:
        angle = math.radians(pair.angle)
        matrix[pair.inclined, pair.inclined] = 1.0 / math.cos(angle)
        if compensated:
            matrix[pair.orthogonal, pair.inclined] = -math.tan(angle)
    return matrix


def cartesian_from_slides(axes: int, pair: InclinedPair | None) -> Floats:
    """Matrix (axes, axes) that takes slide displacements to the Cartesian one: what the metal sees."""
    matrix = np.eye(axes)
    if pair:
        angle = math.radians(pair.angle)
        matrix[pair.inclined, pair.inclined] = math.cos(angle)
        matrix[pair.orthogonal, pair.inclined] = math.sin(angle)
    return matrix
